// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "arch/triangle_approach.hpp"

#include "mesh/closest_on_triangle.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/intersections.h>

#include <Eigen/Geometry>

#include <algorithm>

namespace rhizodont {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

Kernel::Point_3 to_cgal(const Point& p) { return {p.x(), p.y(), p.z()}; }

Kernel::Triangle_3 to_cgal(const Corners& t) { return {to_cgal(t[0]), to_cgal(t[1]), to_cgal(t[2])}; }

bool boxes_meet(const Corners& first, const Corners& second) {
  const Eigen::Array3d low_1 = first[0].cwiseMin(first[1]).cwiseMin(first[2]),
                       high_1 = first[0].cwiseMax(first[1]).cwiseMax(first[2]),
                       low_2 = second[0].cwiseMin(second[1]).cwiseMin(second[2]),
                       high_2 = second[0].cwiseMax(second[1]).cwiseMax(second[2]);
  return (low_1 <= high_2).all() && (low_2 <= high_1).all();
}

/// The part of the segment from `start` along `way`, 0..1, that is nearest to p.
double nearest_part(const Point& start, const Eigen::Vector3d& way, const Point& p) {
  return std::clamp(way.dot(p - start) / way.squaredNorm(), 0.0, 1.0);
}

/// Nearest points of two segments p + s u and q + t v (C. Ericson, "Real-Time Collision Detection", 2005, 5.1.9). Right
/// where both lie inside; where one is an end, the ends' own distances from the other triangle are as small.
void nearest_of_edges(const Point& p, const Eigen::Vector3d& u, const Point& q, const Eigen::Vector3d& v,
                      TriangleApproach& nearest) {
  const Eigen::Vector3d r = p - q;
  const double a = u.squaredNorm(), e = v.squaredNorm(), b = u.dot(v), c = u.dot(r), f = v.dot(r);
  const double parallel = a * e - b * b;
  if (!(parallel > 0)) return;
  double s = std::clamp((b * f - c * e) / parallel, 0.0, 1.0), t = nearest_part(q, v, p + s * u);
  // Beside nearly parallel segments the quotient is coarse: going to and fro once more mends what matters.
  s = nearest_part(p, u, q + t * v);
  t = nearest_part(q, v, p + s * u);
  const double squared = (r + s * u - t * v).squaredNorm();
  if (squared < nearest.squared_distance) nearest = {squared, p + s * u, q + t * v};
}

/// A point in both of two triangles that meet: a crossing of an edge, or, where they lie in one plane, none: the
/// nearest.
void set_common_point(const Corners& first, const Corners& second, TriangleApproach& nearest) {
  for (std::size_t i = 0; i < 3; ++i) {
    const Point &p = first[i], &q = first[(i + 1) % 3], &r = second[i], &s = second[(i + 1) % 3];
    if (const double at = crossing_of_edge(p, q, second); at >= 0) {
      nearest.on_first = nearest.on_second = p + at * (q - p);
      return;
    }
    if (const double at = crossing_of_edge(r, s, first); at >= 0) {
      nearest.on_first = nearest.on_second = r + at * (s - r);
      return;
    }
  }
  nearest.on_second = nearest.on_first;
}

}  // namespace

bool has_no_area(const Corners& t) { return CGAL::collinear(to_cgal(t[0]), to_cgal(t[1]), to_cgal(t[2])); }

bool triangles_meet(const Corners& first, const Corners& second) {
  return boxes_meet(first, second) && CGAL::do_intersect(to_cgal(first), to_cgal(second));
}

double crossing_of_edge(const Point& p, const Point& q, const Corners& t) {
  if (p == q || !CGAL::do_intersect(to_cgal(t), Kernel::Segment_3(to_cgal(p), to_cgal(q)))) return -1;
  const Eigen::Vector3d normal = (t[1] - t[0]).cross(t[2] - t[0]);
  const double from = normal.dot(p - t[0]), to = normal.dot(q - t[0]);
  if (from == to) return -1;
  return std::clamp(from / (from - to), 0.0, 1.0);
}

TriangleApproach nearest_of_triangles(const Corners& first, const Corners& second) {
  TriangleApproach nearest{std::numeric_limits<double>::infinity(), first[0], second[0]};
  for (const Point& p : first) {
    const OnTriangle found = closest_on_triangle(p, second[0], second[1], second[2]);
    if (found.squared_distance < nearest.squared_distance) nearest = {found.squared_distance, p, found.point};
  }
  for (const Point& p : second) {
    const OnTriangle found = closest_on_triangle(p, first[0], first[1], first[2]);
    if (found.squared_distance < nearest.squared_distance) nearest = {found.squared_distance, found.point, p};
  }
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      nearest_of_edges(first[i], first[(i + 1) % 3] - first[i], second[j], second[(j + 1) % 3] - second[j], nearest);
  if (nearest.squared_distance > 0 && triangles_meet(first, second)) {
    nearest.squared_distance = 0;
    set_common_point(first, second, nearest);
  }
  return nearest;
}

}  // namespace rhizodont
