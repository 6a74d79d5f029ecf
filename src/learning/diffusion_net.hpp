// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Private to this room: brings in torch.

#include <vector>

#include "learning/layers.hpp"
#include "networks/surface_sample.hpp"
#include "networks/surface_shape.hpp"

namespace rhizodont {

/// A surface as tensors.
struct SurfaceTensors {
  torch::Tensor features;                ///< float, n x surface_feature_count
  torch::Tensor mass;                    ///< float, n x 1
  torch::Tensor eigenvalues;             ///< float, k x 1
  torch::Tensor basis;                   ///< float, n x k
  torch::Tensor first, neighbours;       ///< int32: the gradients' entries, as in SurfaceSample
  torch::Tensor gradient_x, gradient_y;  ///< float, per entry
  torch::Tensor labels;                  ///< float, n; undefined without labels
};

/// Copies a sample. Throws as check_surface_sample.
SurfaceTensors to_tensors(const SurfaceSample& sample, bool labelled);

/// Values (n x C) spread by heat flow on the surface, each channel over its own time (C, >= 0), within the span of the
/// eigenvectors: sum over k of exp(-eigenvalue_k time_c) phi_k <phi_k, x_c>.
torch::Tensor diffuse(const SurfaceTensors& surface, const torch::Tensor& values, const torch::Tensor& times);

/// Gradients of values (n x C): n x 2 C, the channels' derivatives along the first axis, then along the second.
torch::Tensor surface_gradient(const SurfaceTensors& surface, const torch::Tensor& values);

/// One block: diffusion, products of gradients, and an MLP at each vertex, added to what came in.
struct DiffusionBlockImpl : torch::nn::Module {
  explicit DiffusionBlockImpl(std::int64_t width);
  torch::Tensor forward(const SurfaceTensors& surface, const torch::Tensor& x);

  /// tanh of the inner product of each channel's gradient with a learned combination of all channels' gradients, each
  /// turned and scaled in the tangent plane: the same for any choice of the plane's axes.
  torch::Tensor gradient_features(const SurfaceTensors& surface, const torch::Tensor& spread);

  torch::Tensor time;  ///< C, units of area
  torch::Tensor rotation_real, rotation_imaginary;
  std::vector<layers::Linear> mlp;
};
TORCH_MODULE(DiffusionBlock);

/// DiffusionNet (N. Sharp et al., 2022) with one output per vertex, before the logistic function.
struct DiffusionNetImpl : torch::nn::Module {
  explicit DiffusionNetImpl(const SurfaceShape& shape);
  torch::Tensor forward(const SurfaceTensors& surface);

  SurfaceShape shape_;
  torch::Tensor columns_;  ///< of the features that the network looks at
  layers::Linear first{nullptr}, last{nullptr};
  std::vector<DiffusionBlock> blocks;
};
TORCH_MODULE(DiffusionNet);

}  // namespace rhizodont
