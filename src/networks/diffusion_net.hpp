// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "networks/layers.hpp"
#include "networks/safetensors.hpp"
#include "networks/surface_sample.hpp"
#include "networks/surface_shape.hpp"

#include <vector>

namespace rhizodont::networks {

/// Values (n x C) spread by heat flow on the surface, each channel over its own time (C, >= 0), within the span of the
/// eigenvectors: sum over k of exp(-eigenvalue_k time_c) phi_k <phi_k, x_c>. Sums over vertices go by blocks of fixed
/// size, in their order.
Matrix diffuse(const SurfaceSample& surface, const Matrix& values, const Eigen::RowVectorXf& times);

/// Gradients of values (n x C): 2 n x C, for each vertex the channels' derivatives along the first axis of its tangent
/// plane, then along the second.
Matrix surface_gradient(const SurfaceSample& surface, const Matrix& values);

/// One block: diffusion, products of gradients, and an MLP at each vertex, added to what came in.
struct DiffusionBlock {
  Eigen::RowVectorXf time;  ///< C, >= 0, units of area
  PackedMatrix rotation;    ///< C x 2 C: turns and scales of gradients, real parts, then imaginary ones
  Mlp mlp;                  ///< with ReLU between its layers
};

/// The finished surface network (N. Sharp et al., DiffusionNet, 2022), one number per vertex.
struct DiffusionNet {
  /// Throws InputError if the file is of another network, or a tensor is missing, of another shape or not finite.
  explicit DiffusionNet(const TensorFile& file);

  SurfaceShape shape;
  std::vector<Eigen::Index> columns;  ///< of the features that the network looks at
  Linear first, last;
  std::vector<DiffusionBlock> blocks;
};

/// Per vertex, before the logistic function. Precondition: `check_surface_sample` has nothing against the surface. The
/// same bits for any number of threads.
Eigen::VectorXf predict(const DiffusionNet& network, const SurfaceSample& surface);

}  // namespace rhizodont::networks
