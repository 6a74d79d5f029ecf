// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "networks/surface_sample.hpp"
#include "operators/eigenbasis.hpp"
#include "operators/surfaces.hpp"

namespace rhizodont::testing {

/// Operators of a mesh and, as features, its positions in units; label 1 where x is above its mean.
inline SurfaceSample surface_sample(const TriangleMesh& mesh, int eigenvectors) {
  const SurfaceOperators operators = surface_operators(mesh);
  const Eigenbasis basis = eigenbasis(operators, eigenvectors);
  const Eigen::MatrixX3d positions = positions_in_units(mesh, operators);
  const double middle = operators.mass.dot(positions.col(0)) / operators.mass.sum();
  SurfaceSample sample;
  sample.vertices = static_cast<int>(operators.mass.size());
  sample.eigenvectors = eigenvectors;
  for (int j = 0; j < eigenvectors; ++j) sample.eigenvalues.push_back(static_cast<float>(basis.values[j]));
  sample.first.push_back(0);
  for (int v = 0; v < sample.vertices; ++v) {
    sample.mass.push_back(static_cast<float>(operators.mass[v]));
    for (int j = 0; j < eigenvectors; ++j) sample.basis.push_back(static_cast<float>(basis.vectors(v, j)));
    for (int c = 0; c < surface_feature_count; ++c)
      sample.features.push_back(c < 3 ? static_cast<float>(positions(v, c)) : 0.1F);
    sample.labels.push_back(positions(v, 0) > middle ? 1 : 0);
    Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator y(operators.gradient_y, v);
    for (Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator x(operators.gradient_x, v); x; ++x, ++y) {
      sample.neighbours.push_back(static_cast<std::int32_t>(x.col()));
      sample.gradient_x.push_back(static_cast<float>(x.value()));
      sample.gradient_y.push_back(static_cast<float>(y.value()));
    }
    sample.first.push_back(static_cast<std::int32_t>(sample.neighbours.size()));
  }
  return sample;
}

}  // namespace rhizodont::testing
