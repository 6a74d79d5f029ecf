// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "mesh/cross_sections.hpp"
#include "mesh/diagnosis.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

namespace rhizodont {
namespace {

/// Twice the signed area of the triangle that the axis and the piece of a plane within a surface triangle span.
double swept(const std::array<Point, 3>& corners, const std::array<double, 3>& heights, const Eigen::Vector3d& axis,
             double level) {
  Point into = Point::Zero(), out_of = Point::Zero();
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t k = (i + 1) % 3;
    const bool is_below = heights[i] < level;
    if (is_below == (heights[k] < level)) continue;
    const double share = (level - heights[i]) / (heights[k] - heights[i]);
    (is_below ? out_of : into) = corners[i] + share * (corners[k] - corners[i]);
  }
  return axis.dot(into.cross(out_of));
}

}  // namespace

std::vector<double> cross_section_areas(const TriangleMesh& closed_surface, const Eigen::Vector3d& axis, double from,
                                        double step) {
  assert(diagnose(closed_surface).is_closed_manifold());
  double lowest = std::numeric_limits<double>::infinity();
  for (const Triangle& t : closed_surface.triangles)
    for (const int v : t) lowest = std::min(lowest, closed_surface.vertices[static_cast<std::size_t>(v)].dot(axis));
  if (!(lowest < from)) return {};
  std::vector<double> areas(1 + static_cast<std::size_t>((from - lowest) / step), 0);
  for (const Triangle& t : closed_surface.triangles) {
    std::array<Point, 3> corners;
    std::array<double, 3> heights{};
    for (std::size_t i = 0; i < 3; ++i) {
      corners[i] = closed_surface.vertices[static_cast<std::size_t>(t[i])];
      heights[i] = corners[i].dot(axis);
    }
    const auto [low, high] = std::minmax_element(heights.begin(), heights.end());
    for (double k = std::max(0.0, std::ceil((from - *high) / step)); k < static_cast<double>(areas.size()); ++k) {
      const double level = from - k * step;
      if (level < *low) break;
      areas[static_cast<std::size_t>(k)] += swept(corners, heights, axis, level) / 2;
    }
  }
  for (double& area : areas) area = std::abs(area);
  return areas;
}

}  // namespace rhizodont
