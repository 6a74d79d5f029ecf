// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Closest point of a triangle by the regions of its plane: C. Ericson, "Real-Time Collision Detection", 2005, 5.1.5.

#include "fusion/surface_walk.hpp"

#include "mesh/geometry.hpp"

#include <limits>

namespace rhizodont {
namespace {

/// Closest point of a triangle and where it lies: inside, on the edge from `feature` on, or at corner `feature`.
struct OnTriangle {
  enum class Where { inside, edge, corner };
  Point point;
  Where where = Where::inside;
  int feature = 0;
};

OnTriangle closest_on_triangle(const Point& p, const Point& a, const Point& b, const Point& c) {
  using Where = OnTriangle::Where;
  const Eigen::Vector3d ab = b - a, ac = c - a, ap = p - a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return {a, Where::corner, 0};
  const Eigen::Vector3d bp = p - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return {b, Where::corner, 1};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return {a + d1 / (d1 - d3) * ab, Where::edge, 0};
  const Eigen::Vector3d cp = p - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return {c, Where::corner, 2};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return {a + d2 / (d2 - d6) * ac, Where::edge, 2};
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
    return {b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b), Where::edge, 1};
  const double sum = va + vb + vc;
  return {a + vb / sum * ab + vc / sum * ac, Where::inside, 0};
}

}  // namespace

SurfaceWalk::SurfaceWalk(const TriangleMesh& surface)
    : surface_(surface), adjacency_(triangle_adjacency(surface)), around_(vertex_triangles(surface)) {
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
