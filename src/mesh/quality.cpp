// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// The five figures of "Completing Dental Models While Preserving Crown Geometry and Meshing Topology", section 4.3.
#include "mesh/quality.hpp"

#include "mesh/geometry.hpp"
#include "rhizodont/error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace rhizodont {

double triangle_quality(const TriangleMesh& mesh, std::size_t triangle) {
  double perimeter = 0, longest = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double length = (mesh.vertices[static_cast<std::size_t>(mesh.triangles[triangle][(i + 1) % 3])] -
                           mesh.vertices[static_cast<std::size_t>(mesh.triangles[triangle][i])])
                              .norm();
    perimeter += length;
    longest = std::max(longest, length);
  }
  const double area = triangle_area(mesh, triangle);
  if (!(area > 0)) return 0;
  return std::min(1.0, 6 * area / (std::numbers::sqrt3 * (perimeter / 2) * longest));
}

std::optional<QualityFigures> quality(const TriangleMesh& mesh, const std::vector<bool>& mask) {
  if (mask.size() != mesh.triangles.size()) throw UsageError("a triangle mask needs one entry per triangle");
  constexpr double degrees = 180 / std::numbers::pi;
  QualityFigures figures;
  figures.q_min = figures.theta_min = std::numeric_limits<double>::infinity();
  std::size_t small_angles = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (!mask[t]) continue;
    ++figures.triangles;
    const double q = triangle_quality(mesh, t);
    figures.q_avg += q;
    figures.q_min = std::min(figures.q_min, q);
    double smallest = 180;
    for (const double radians : triangle_angles(mesh, t)) {
      const double angle = radians * degrees;
      smallest = std::min(smallest, angle);
      figures.theta_max = std::max(figures.theta_max, angle);
      if (angle < 30) ++small_angles;
    }
    figures.theta_avg += smallest;
    figures.theta_min = std::min(figures.theta_min, smallest);
  }
  if (figures.triangles == 0) return std::nullopt;
  const auto count = static_cast<double>(figures.triangles);
  figures.q_avg /= count;
  figures.theta_avg /= count;
  figures.percent_below_30 = 100 * static_cast<double>(small_angles) / (3 * count);
  return figures;
}

std::optional<QualityFigures> quality(const TriangleMesh& mesh) {
  return quality(mesh, std::vector<bool>(mesh.triangles.size(), true));
}

}  // namespace rhizodont
