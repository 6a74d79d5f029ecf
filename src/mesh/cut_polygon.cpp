// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/cut_polygon.hpp"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Spatial_sort_traits_adapter_2.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <CGAL/hilbert_sort.h>
#include <CGAL/property_map.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

namespace rhizodont {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<std::int32_t, Kernel>;
using FaceBase =
    CGAL::Constrained_triangulation_face_base_2<Kernel, CGAL::Triangulation_face_base_with_info_2<int, Kernel>>;
using Triangulation =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>,
                                               CGAL::No_constraint_intersection_tag>;
using Point2 = Kernel::Point_2;

std::vector<Triangle> fan_of(std::span<const std::int32_t> corners) {
  std::vector<Triangle> fan;
  for (std::size_t k = 2; k < corners.size(); ++k) fan.push_back({corners[0], corners[k - 1], corners[k]});
  return fan;
}

/// The corners along the axis nearest to the area vector, counterclockwise; coordinates are taken over, not computed,
/// so that what is collinear stays so. Nothing for a polygon without area.
std::optional<std::vector<Point2>> seen_along_axis(const std::vector<Point>& vertices,
                                                   std::span<const std::int32_t> corners) {
  const auto at = [&](std::size_t k) -> const Point& { return vertices[static_cast<std::size_t>(corners[k])]; };
  Eigen::Vector3d area = Eigen::Vector3d::Zero();
  for (std::size_t k = 2; k < corners.size(); ++k) area += (at(k - 1) - at(0)).cross(at(k) - at(0));
  Eigen::Index axis = 0;
  if (!(area.cwiseAbs().maxCoeff(&axis) > 0)) return std::nullopt;
  Eigen::Index first = (axis + 1) % 3, second = (axis + 2) % 3;
  if (area[axis] < 0) std::swap(first, second);
  std::vector<Point2> points;
  for (std::size_t k = 0; k < corners.size(); ++k) points.emplace_back(at(k)[first], at(k)[second]);
  return points;
}

/// No triangle of the fan is turned over by more than what rounding its corners to float may do.
bool fan_is_right(const std::vector<Point2>& points) {
  double magnitude = 0, reach = 0;
  for (const Point2& p : points) {
    magnitude = std::max({magnitude, std::abs(p.x()), std::abs(p.y())});
    reach = std::max({reach, std::abs(p.x() - points[0].x()), std::abs(p.y() - points[0].y())});
  }
  const double tolerance = 0x1p-22 * magnitude * reach;
  for (std::size_t k = 2; k < points.size(); ++k) {
    const double twice_area = (points[k - 1].x() - points[0].x()) * (points[k].y() - points[0].y()) -
                              (points[k - 1].y() - points[0].y()) * (points[k].x() - points[0].x());
    if (twice_area < -tolerance) return false;
  }
  return true;
}

/// Edges of the outline; one that is walked both ways is a bridge to a hole and no border.
std::vector<std::pair<std::int32_t, std::int32_t>> border_edges(std::span<const std::int32_t> corners) {
  std::map<std::pair<std::int32_t, std::int32_t>, int> walked;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const std::int32_t a = corners[k], b = corners[(k + 1) % corners.size()];
    if (a != b) walked[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
  }
  std::vector<std::pair<std::int32_t, std::int32_t>> edges;
  for (const auto& [edge, balance] : walked)
    if (balance != 0) edges.push_back(edge);
  return edges;
}

/// Counts for every face the borders between it and the outside.
void mark_inside(Triangulation& triangulation) {
  for (auto face : triangulation.all_face_handles()) face->info() = -1;
  triangulation.infinite_face()->info() = 0;
  std::vector<Triangulation::Face_handle> reached{triangulation.infinite_face()};
  while (!reached.empty()) {
    const Triangulation::Face_handle face = reached.back();
    reached.pop_back();
    for (int i = 0; i < 3; ++i) {
      const Triangulation::Face_handle next = face->neighbor(i);
      if (next->info() >= 0) continue;
      next->info() = face->info() ^ static_cast<int>(face->is_constrained(i));
      reached.push_back(next);
    }
  }
}

/// The order in which corners are inserted: along the outline each one may see most of those before it, which takes
/// minutes for very many; along a curve that fills the plane it sees a few.
std::vector<std::size_t> insertion_order(const std::vector<Point2>& points) {
  constexpr std::size_t many = 2000;
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  if (points.size() < many) return order;
  using Map = CGAL::Pointer_property_map<Point2>::const_type;
  CGAL::hilbert_sort(order.begin(), order.end(),
                     CGAL::Spatial_sort_traits_adapter_2<Kernel, Map>(CGAL::make_property_map(points)));
  return order;
}

/// Nothing where the outline cuts or touches itself.
std::optional<std::vector<Triangle>> cut_inside(const std::vector<Point2>& points,
                                                std::span<const std::int32_t> corners) {
  Triangulation triangulation;
  std::map<std::int32_t, Triangulation::Vertex_handle> handles;
  Triangulation::Face_handle near;
  for (const std::size_t k : insertion_order(points)) {
    if (handles.contains(corners[k])) continue;
    const auto handle = triangulation.insert(points[k], near);
    near = handle->face();
    handle->info() = corners[k];
    handles[corners[k]] = handle;
  }
  if (triangulation.dimension() < 2 || triangulation.number_of_vertices() != handles.size()) return std::nullopt;
  try {
    for (const auto& [a, b] : border_edges(corners)) triangulation.insert_constraint(handles[a], handles[b]);
  } catch (const Triangulation::Intersection_of_constraints_exception&) {
    return std::nullopt;
  }
  mark_inside(triangulation);
  std::vector<Triangle> triangles;
  for (auto face : triangulation.finite_face_handles())
    if (face->info() == 1)
      triangles.push_back({face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()});
  // A corner named twice in a row adds a triangle without area.
  for (std::size_t k = 0; k < corners.size(); ++k)
    if (corners[k] == corners[(k + 1) % corners.size()]) triangles.push_back({corners[k], corners[k], corners[k]});
  if (triangles.size() + 2 != corners.size()) return std::nullopt;
  return triangles;
}

}  // namespace

CutPolygon cut_polygon(const std::vector<Point>& vertices, std::span<const std::int32_t> corners) {
  assert(std::all_of(corners.begin(), corners.end(), [&](std::int32_t v) {
    return v >= 0 && static_cast<std::size_t>(v) < vertices.size() && vertices[static_cast<std::size_t>(v)].allFinite();
  }));
  const auto points = seen_along_axis(vertices, corners);
  if (!points || fan_is_right(*points)) return {fan_of(corners), PolygonCut::fan};
  if (auto triangles = cut_inside(*points, corners)) return {std::move(*triangles), PolygonCut::constrained};
  return {fan_of(corners), PolygonCut::fan_as_it_cuts};
}

}  // namespace rhizodont
