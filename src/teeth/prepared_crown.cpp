// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "teeth/prepared_crown.hpp"

#include "teeth/frame.hpp"

#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <utility>

namespace rhizodont {

PreparedCrown prepare_crown(TriangleMesh open_crown) {
  const Eigen::Vector3d axis = growth_axis(open_crown);
  CrownBorder border = find_crown_border(open_crown);
  ClosestPointIndex surface(open_crown);
  return {std::move(open_crown), axis, std::move(border), std::move(surface)};
}

bool lies_on_border(const PreparedCrown& prepared, const ClosestPoint& closest) {
  const TriangleMesh& crown = prepared.mesh;
  const CrownBorder& border = prepared.border;
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

CrownDistances crown_distances(const TriangleMesh& guiding_surface, const PreparedCrown& crown) {
  const std::size_t n = guiding_surface.vertices.size();
  CrownDistances result;
  result.distance.resize(n);
  std::vector<char> on_border(n);
  tbb::parallel_for(std::size_t{0}, n, [&](std::size_t v) {
    const ClosestPoint closest = crown.surface.closest(guiding_surface.vertices[v]);
    result.distance[v] = closest.distance;
    on_border[v] = lies_on_border(crown, closest) ? 1 : 0;
  });
  result.closest_on_border.assign(on_border.begin(), on_border.end());
  return result;
}

}  // namespace rhizodont
