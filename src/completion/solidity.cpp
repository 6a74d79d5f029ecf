// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "completion/solidity.hpp"

#include "base/disjoint_sets.hpp"
#include "mesh/cross_sections.hpp"
#include "mesh/nearest_vertex.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace rhizodont {

Solidity solidity(const PredictedTooth& predicted, const Eigen::Vector3d& growth_axis, double level) {
  constexpr std::size_t neighbours = 12;
  constexpr double gap_mm = 0.8;
  const std::vector<Point>& all = predicted.cloud.points;
  const NearestVertexIndex index(all);
  DisjointSets pieces(all.size());
  Solidity result;
  double below = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto near = index.nearest(all[i], neighbours);
    Point middle = Point::Zero();
    for (const NearVertex& n : near) {
      if (n.squared_distance <= gap_mm * gap_mm) pieces.join(static_cast<int>(i), n.index);
      middle += all[static_cast<std::size_t>(n.index)] / static_cast<double>(near.size());
    }
    if (all[i].dot(growth_axis) >= level) continue;
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (const NearVertex& n : near) {
      const Eigen::Vector3d d = all[static_cast<std::size_t>(n.index)] - middle;
      spread += d * d.transpose() / static_cast<double>(near.size());
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(spread, Eigen::EigenvaluesOnly);
    result.scatter += std::sqrt(std::max(0.0, axes.eigenvalues()[0]));
    below += 1;
  }
  std::vector<double> size(all.size(), 0);
  for (std::size_t i = 0; i < all.size(); ++i) size[static_cast<std::size_t>(pieces.find(static_cast<int>(i)))] += 1;
  result.in_one_piece = *std::max_element(size.begin(), size.end()) / static_cast<double>(all.size());
  if (below > 0) result.scatter /= below;
  result.below = below / static_cast<double>(all.size());
  return result;
}

double shreds(const Solidity& solidity) {
  // Wide of what sound roots have by judgement, not by measurement: they catch loose clouds, not every crumbling root.
  constexpr double most_loose = 0.3, most_scatter_mm = 0.5;
  constexpr double least_below = 0.02;  // sound teeth have half of their points there
  if (solidity.below < least_below) return std::numeric_limits<double>::infinity();
  return std::max((1 - solidity.in_one_piece) / most_loose, solidity.scatter / most_scatter_mm);
}

double swelling(const TriangleMesh& tooth, const Eigen::Vector3d& growth_axis, double level) {
  constexpr double below_border_mm = 1;  // where a ragged border no longer shapes the sections
  constexpr double step_mm = 0.4;
  constexpr double least_mm2 = 0.3;  // added to all: apices are thin without being threads
  const std::vector<double> areas = cross_section_areas(tooth, growth_axis, level - below_border_mm, step_mm);
  double most = 1, smallest = std::numeric_limits<double>::infinity();
  if (areas.empty()) return smallest;
  for (const double area : areas) {
    smallest = std::min(smallest, area);
    most = std::max(most, (area + least_mm2) / (smallest + least_mm2));
  }
  return most;
}

}  // namespace rhizodont
