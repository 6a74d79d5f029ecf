// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "fusion/crown_border.hpp"

#include "mesh/adjacency.hpp"
#include "rhizodont/error.hpp"

#include <Eigen/Geometry>

#include <algorithm>

namespace rhizodont {

CrownBorder find_crown_border(const TriangleMesh& crown) {
  CrownBorder border;
  border.is_vertex.assign(crown.vertices.size(), false);
  const EdgeTable table = edge_table(crown);
  for (std::size_t e = 0; e < table.size(); ++e) {
    if (table.triangle_count(e) != 1) continue;
    const auto [a, b] = table.vertices[e];
    border.edges.insert({a, b});
    border.is_vertex[static_cast<std::size_t>(a)] = border.is_vertex[static_cast<std::size_t>(b)] = true;
    border.mean_edge +=
        (crown.vertices[static_cast<std::size_t>(a)] - crown.vertices[static_cast<std::size_t>(b)]).norm();
  }
  if (border.edges.empty()) throw InputError("The crown is closed: without an open base there is no place for a root.");
  border.mean_edge /= static_cast<double>(border.edges.size());
  return border;
}

bool lies_on_border(const TriangleMesh& crown, const CrownBorder& border, const ClosestPoint& closest) {
  const Triangle& t = crown.triangles[static_cast<std::size_t>(closest.triangle)];
  const double tolerance = 1e-7 * border.mean_edge;
  for (std::size_t i = 0; i < 3; ++i) {
    const int a = t[i];
    const int b = t[(i + 1) % 3];
    const Point& pa = crown.vertices[static_cast<std::size_t>(a)];
    const Point& pb = crown.vertices[static_cast<std::size_t>(b)];
    if (border.is_vertex[static_cast<std::size_t>(a)] && (closest.point - pa).norm() <= tolerance) return true;
    if (!border.edges.contains({std::min(a, b), std::max(a, b)})) continue;
    const Eigen::Vector3d along = pb - pa;
    if ((closest.point - pa).cross(along).norm() <= tolerance * along.norm()) return true;
  }
  return false;
}

}  // namespace rhizodont
