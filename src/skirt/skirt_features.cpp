// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// "Completing Dental Models While Preserving Crown Geometry and Meshing Topology", 3.2: positions and heat kernel
//   signatures side by side. Distance to the border and curvature are added because the skirt is at the border and
//   begins with a crease.
#include "skirt/skirt_features.hpp"

#include "mesh/border_pieces.hpp"
#include "mesh/geometry.hpp"
#include "operators/eigenbasis.hpp"
#include "operators/geodesic.hpp"
#include "operators/surface_operators.hpp"
#include "rhizodont/error.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace rhizodont {
namespace {

constexpr int signatures = surface_feature_count - SurfaceFeature::signature;
constexpr double unit_mm = 6;

Eigen::Matrix3d upright(const TriangleMesh& crown) {
  const Eigen::Vector3d axis = area_vector(crown);
  if (!(axis.norm() > 1e-6 * surface_area(crown)))
    throw InputError("The crown's border does not tell where its root would be.");
  return Eigen::Quaterniond::FromTwoVectors(axis.normalized(), Eigen::Vector3d::UnitZ().eval()).toRotationMatrix();
}

/// Mean curvature times the width over which the surface was smoothed to find it.
Eigen::VectorXd curvature(const SurfaceOperators& operators, const Eigen::MatrixX3d& positions, double width) {
  const Eigen::MatrixXd moved = positions - diffused(operators, positions, width * width);
  return (moved.array() * operators.normals.array()).rowwise().sum() / width;
}

void set_operators(SurfaceSample& sample, const SurfaceOperators& operators, const Eigenbasis& basis) {
  const Eigen::Index n = operators.mass.size(), k = basis.values.size();
  sample.vertices = static_cast<int>(n);
  sample.eigenvectors = static_cast<int>(k);
  for (Eigen::Index v = 0; v < n; ++v) sample.mass.push_back(static_cast<float>(operators.mass[v]));
  for (Eigen::Index j = 0; j < k; ++j) sample.eigenvalues.push_back(static_cast<float>(basis.values[j]));
  sample.basis.reserve(static_cast<std::size_t>(n * k));
  for (Eigen::Index v = 0; v < n; ++v)
    for (Eigen::Index j = 0; j < k; ++j) sample.basis.push_back(static_cast<float>(basis.vectors(v, j)));
  sample.first.push_back(0);
  for (Eigen::Index v = 0; v < n; ++v) {
    Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator y(operators.gradient_y, v);
    for (Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator x(operators.gradient_x, v); x; ++x, ++y) {
      sample.neighbours.push_back(static_cast<std::int32_t>(x.col()));
      sample.gradient_x.push_back(static_cast<float>(x.value()));
      sample.gradient_y.push_back(static_cast<float>(y.value()));
    }
    sample.first.push_back(static_cast<std::int32_t>(sample.neighbours.size()));
  }
}

}  // namespace

SurfaceSample skirt_features(const TriangleMesh& crown, int eigenvectors) {
  const SurfaceOperators operators = surface_operators(crown);
  const auto n = static_cast<Eigen::Index>(crown.vertices.size());
  const int fewer = std::min(eigenvectors, static_cast<int>(n / 2) - 8);
  if (fewer < 1) throw InputError("The crown has too few vertices to tell its skirt.");
  const Eigenbasis basis = eigenbasis(operators, fewer);
  SurfaceSample sample;
  set_operators(sample, operators, basis);

  Eigen::VectorXd times(signatures);
  for (int i = 0; i < signatures; ++i) times[i] = 0.02 * std::pow(75.0, i / (signatures - 1.0));
  const Eigen::MatrixXd signature = heat_kernel_signatures(basis, times);
  const Eigen::MatrixX3d positions = positions_in_units(crown, operators);
  const Eigen::VectorXd fine = curvature(operators, positions, 0.35 / operators.unit);
  const Eigen::VectorXd coarse = curvature(operators, positions, 0.9 / operators.unit);
  const std::vector<BorderPiece> border = border_pieces(crown);
  if (border.empty()) throw InputError("The crown is closed: a skirt is looked for at a border.");
  std::vector<int> at_border;
  for (const BorderPiece& piece : border)
    at_border.insert(at_border.end(), piece.vertices.begin(), piece.vertices.end());
  std::sort(at_border.begin(), at_border.end());
  const std::vector<double> to_border = geodesic_distances(crown, at_border);
  const std::vector<double> to_outer = geodesic_distances(crown, border[base_piece(border)].vertices);
  const Eigen::Matrix3d turn = upright(crown);
  const Point centre = area_centroid(crown);

  sample.features.reserve(static_cast<std::size_t>(n) * surface_feature_count);
  const auto add = [&](double x) { sample.features.push_back(static_cast<float>(x)); };
  for (Eigen::Index v = 0; v < n; ++v) {
    const auto i = static_cast<std::size_t>(v);
    const Point position = turn * (crown.vertices[i] - centre) / unit_mm;
    const Eigen::Vector3d normal = turn * operators.normals.row(v).transpose();
    for (int c = 0; c < 3; ++c) add(position[c]);
    for (int c = 0; c < 3; ++c) add(normal[c]);
    add(std::exp(-to_border[i] / 0.7));
    add(std::exp(-to_outer[i] / 2.5));
    add(std::clamp(3 * fine[v], -3.0, 3.0));
    add(std::clamp(2 * coarse[v], -3.0, 3.0));
    for (int j = 0; j < signatures; ++j) add(0.5 * std::log(4 * std::numbers::pi * std::max(signature(v, j), 1e-6)));
  }
  return sample;
}

}  // namespace rhizodont
