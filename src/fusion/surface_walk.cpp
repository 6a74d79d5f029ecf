// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "fusion/surface_walk.hpp"

#include "mesh/closest_on_triangle.hpp"
#include "mesh/geometry.hpp"

#include <limits>

namespace rhizodont {
SurfaceWalk::SurfaceWalk(const TriangleMesh& surface)
    : surface_(surface),
      adjacency_(triangle_adjacency(surface)),
      around_(vertex_triangles(surface)),
      vertices_(surface.vertices) {
  normals_.reserve(surface.triangles.size());
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) normals_.push_back(triangle_normal(surface, t));
}

SurfacePlace SurfaceWalk::closest(const Point& p, int start) const {
  const auto on = [&](int t) {
    const Triangle& tri = surface_.triangles[static_cast<std::size_t>(t)];
    return closest_on_triangle(p, surface_.vertices[static_cast<std::size_t>(tri[0])],
                               surface_.vertices[static_cast<std::size_t>(tri[1])],
                               surface_.vertices[static_cast<std::size_t>(tri[2])]);
  };
  int triangle = start;
  OnTriangle best = on(start);
  double best_distance = (best.point - p).squaredNorm();
  while (best.where != OnTriangle::Where::inside) {
    int next = -1;
    OnTriangle next_best;
    const auto consider = [&](int t) {
      if (t < 0 || t == triangle) return;
      const OnTriangle candidate = on(t);
      const double distance = (candidate.point - p).squaredNorm();
      if (!(distance < best_distance)) return;
      best_distance = distance;
      next_best = candidate;
      next = t;
    };
    const auto feature = static_cast<std::size_t>(best.feature);
    if (best.where == OnTriangle::Where::edge) {
      consider(adjacency_.neighbours[static_cast<std::size_t>(triangle)][feature]);
    } else {
      const auto v = static_cast<std::size_t>(surface_.triangles[static_cast<std::size_t>(triangle)][feature]);
      for (int i = around_.first[v]; i < around_.first[v + 1]; ++i)
        consider(around_.triangles[static_cast<std::size_t>(i)]);
    }
    if (next < 0) break;
    triangle = next;
    best = next_best;
  }
  return {best.point, triangle};
}

}  // namespace rhizodont
