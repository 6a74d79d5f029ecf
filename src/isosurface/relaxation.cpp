// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Local improvement of a triangulation by moves that are taken only if the worst triangle gains (Freitag and
// Ollivier-Gooch 1997).
#include "isosurface/relaxation.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <set>

#include "isosurface/incidence.hpp"

namespace rhizodont {
namespace {

class Relaxation {
 public:
  Relaxation(const ScalarField& field, double iso, const IsosurfaceOptions& options, std::vector<EdgeVertex>& vertices,
             const std::vector<Triangle>& triangles)
      : field_(field),
        iso_(iso),
        options_(options),
        vertices_(vertices),
        triangles_(triangles),
        incidence_(vertices.size(), triangles) {}

  std::size_t run() {
    constexpr int most_rounds = 10;
    std::set<std::int32_t> moved, poor = vertices_of_poor_triangles();
    for (int round = 0; round < most_rounds && !poor.empty(); ++round) {
      bool any = false;
      for (const std::int32_t v : poor)
        if (improve(v)) {
          moved.insert(v);
          any = true;
        }
      if (!any) break;
      poor = vertices_of_poor_triangles();
    }
    return moved.size();
  }

 private:
  /// At least 1 for a triangle with angles of 35.26 to 101.54 degrees, GradNormal's range in the limit of small e; less
  /// in proportion for a smaller or a larger angle; negative if it faces into the solid.
  double quality(const Triangle& triangle) const {
    constexpr double degree = std::numbers::pi / 180.0, smallest = 35.26 * degree, largest = 101.54 * degree;
    const EdgeVertex& a = vertices_[static_cast<std::size_t>(triangle[0])];
    const EdgeVertex& b = vertices_[static_cast<std::size_t>(triangle[1])];
    const EdgeVertex& c = vertices_[static_cast<std::size_t>(triangle[2])];
    const Eigen::Vector3d ab = b.position - a.position, bc = c.position - b.position, ca = a.position - c.position;
    const Eigen::Vector3d normal = ab.cross(bc);
    const double area = normal.norm();
    const std::array<double, 3> angles{std::atan2(area, -ab.dot(ca)), std::atan2(area, -bc.dot(ab)),
                                       std::atan2(area, -ca.dot(bc))};
    const auto [least, most] = std::ranges::minmax(angles);
    const double size = std::min(least / smallest, (std::numbers::pi - most) / (std::numbers::pi - largest));
    return normal.dot(a.normal + b.normal + c.normal) > 0.0 ? size : size - 2.0;
  }

  double worst_around(std::int32_t v) const {
    double worst = 2.0;
    for (const std::size_t t : incidence_.of(v)) worst = std::min(worst, quality(triangles_[t]));
    return worst;
  }

  std::set<std::int32_t> vertices_of_poor_triangles() const {
    std::set<std::int32_t> poor;
    for (const Triangle& triangle : triangles_)
      if (quality(triangle) < 1.0) poor.insert(triangle.begin(), triangle.end());
    return poor;
  }

  bool improve(std::int32_t v) {
    EdgeVertex& vertex = vertices_[static_cast<std::size_t>(v)];
    Point centre = Point::Zero();
    for (const std::size_t t : incidence_.of(v))
      for (const std::int32_t n : triangles_[t])
        if (n != v) centre += vertices_[static_cast<std::size_t>(n)].position;
    centre /= 2.0 * static_cast<double>(incidence_.valence(v));
    const EdgeVertex before = vertex;
    const double worst = worst_around(v);
    for (const double step : {1.0, 0.5, 0.2}) {
      std::optional<Point> target = before.position + step * (centre - before.position);
      if (before.on_surface) target = settle(field_, iso_, *target, 0.3 * options_.e, options_.tolerance);
      if (!target || (*target - before.position).norm() > 0.5 * options_.e) continue;
      vertex.position = *target;
      if (before.on_surface) vertex.normal = outward_normal(field_, *target);
      if (worst_around(v) > worst + 1e-4) return true;
      vertex = before;
    }
    return false;
  }

  const ScalarField& field_;
  double iso_;
  const IsosurfaceOptions& options_;
  std::vector<EdgeVertex>& vertices_;
  const std::vector<Triangle>& triangles_;
  VertexIncidence incidence_;
};

}  // namespace

std::size_t relax_poor_triangles(const ScalarField& field, double iso, const IsosurfaceOptions& options,
                                 std::vector<EdgeVertex>& vertices, const std::vector<Triangle>& triangles) {
  return Relaxation(field, iso, options, vertices, triangles).run();
}

}  // namespace rhizodont
