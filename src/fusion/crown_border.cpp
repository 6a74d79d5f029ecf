// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "fusion/crown_border.hpp"

#include "mesh/adjacency.hpp"
#include "rhizodont/error.hpp"

#include <tbb/parallel_for.h>
#include <Eigen/Geometry>

namespace rhizodont {
bool lies_on_border(const TriangleMesh& crown, const CrownBorder& border, const ClosestPoint& closest) {
  const Triangle& t = crown.triangles[static_cast<std::size_t>(closest.triangle)];
  const double tolerance = 1e-7 * border.mean_edge;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto a = static_cast<std::size_t>(t[i]);
    const Point& pa = crown.vertices[a];
    if (border.is_vertex[a] && (closest.point - pa).norm() <= tolerance) return true;
    if (!border.is_edge[static_cast<std::size_t>(closest.triangle)][i]) continue;
    const Eigen::Vector3d along = crown.vertices[static_cast<std::size_t>(t[(i + 1) % 3])] - pa;
    if ((closest.point - pa).cross(along).norm() <= tolerance * along.norm()) return true;
  }
  return false;
}

CrownBorder find_crown_border(const TriangleMesh& crown) {
  CrownBorder border;
  border.is_vertex.assign(crown.vertices.size(), false);
  border.is_edge.assign(crown.triangles.size(), {false, false, false});
  const EdgeTable table = edge_table(crown);
  for (std::size_t e = 0; e < table.size(); ++e) {
    if (table.triangle_count(e) != 1) continue;
    const int h = table.half_edges[static_cast<std::size_t>(table.first[e])];
    const int a = half_edge_from(crown, h), b = half_edge_to(crown, h);
    border.half_edges.emplace_back(a, b);
    border.is_edge[static_cast<std::size_t>(h / 3)][static_cast<std::size_t>(h % 3)] = true;
    border.is_vertex[static_cast<std::size_t>(a)] = border.is_vertex[static_cast<std::size_t>(b)] = true;
    border.mean_edge +=
        (crown.vertices[static_cast<std::size_t>(a)] - crown.vertices[static_cast<std::size_t>(b)]).norm();
  }
  if (border.half_edges.empty())
    throw InputError("The crown is closed: without an open base there is no place for a root.");
  border.mean_edge /= static_cast<double>(border.half_edges.size());
  return border;
}

CrownDistances crown_distances(const TriangleMesh& guiding_surface, const TriangleMesh& crown,
                               const CrownBorder& border) {
  const ClosestPointIndex index(crown);
  const std::size_t n = guiding_surface.vertices.size();
  CrownDistances result;
  result.distance.resize(n);
  std::vector<char> on_border(n);
  tbb::parallel_for(std::size_t{0}, n, [&](std::size_t v) {
    const ClosestPoint closest = index.closest(guiding_surface.vertices[v]);
    result.distance[v] = closest.distance;
    on_border[v] = lies_on_border(crown, border, closest) ? 1 : 0;
  });
  result.closest_on_border.assign(on_border.begin(), on_border.end());
  return result;
}

}  // namespace rhizodont
