// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "arch/solid_surface.hpp"

#include "mesh/adjacency.hpp"
#include "mesh/at.hpp"
#include "mesh/closest_on_triangle.hpp"
#include "mesh/geometry.hpp"
#include "mesh/mesh_checks.hpp"
#include "rhizodont/error.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace rhizodont {
namespace {

void require_parts(const TriangleMesh& mesh, const std::vector<int>& part_of_triangle, int part_count) {
  if (part_count < 1 || part_count > 32)
    throw UsageError(fmt::format("A surface cannot be split in {} parts: 1 to 32 are possible.", part_count));
  if (part_of_triangle.size() != mesh.triangles.size())
    throw UsageError(fmt::format("{} triangles are given with {} numbers of parts.", mesh.triangles.size(),
                                 part_of_triangle.size()));
  for (const int k : part_of_triangle)
    if (k < 0 || k >= part_count) throw UsageError(fmt::format("{} is no part of {} parts.", k, part_count));
}

/// The neighbours over edges of a mesh that is closed and turned alike. Throws InputError for others.
std::vector<std::array<int, 3>> closed_neighbours(const TriangleMesh& mesh) {
  std::vector<std::int64_t> open;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    if (a == b || b == c || c == a) open.push_back(static_cast<std::int64_t>(t));
  }
  if (open.empty()) {
    std::vector<std::array<int, 3>> neighbours = triangle_adjacency(mesh).neighbours;
    for (std::size_t t = 0; t < neighbours.size(); ++t)
      for (std::size_t i = 0; i < 3; ++i) {
        const int other = neighbours[t][i];
        const int from = mesh.triangles[t][i], to = mesh.triangles[t][(i + 1) % 3];
        bool opposite = false;
        if (other >= 0)
          for (std::size_t j = 0; j < 3; ++j)
            opposite |= mesh.triangles[at(other)][j] == to && mesh.triangles[at(other)][(j + 1) % 3] == from;
        if (!opposite) open.push_back(static_cast<std::int64_t>(t));
      }
    if (open.empty()) return neighbours;
  }
  open.erase(std::unique(open.begin(), open.end()), open.end());
  throw InputError("A tooth is no closed solid, so that nothing lies inside or outside of it.", std::move(open),
                   ElementKind::triangles);
}

ClosedBox box_of(const Corners& corners) {
  const Point low = corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]),
              high = corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]);
  return {{low.x(), low.y(), low.z()}, {high.x(), high.y(), high.z()}};
}

}  // namespace

SolidSurface::SolidSurface(TriangleMesh mesh, std::vector<int> part_of_triangle, int part_count)
    : mesh_(std::move(mesh)), part_of_triangle_(std::move(part_of_triangle)) {
  require_valid_indices(mesh_);
  require_finite(mesh_.vertices);
  require_parts(mesh_, part_of_triangle_, part_count);
  neighbours_ = closed_neighbours(mesh_);
  vertex_normals_ = vertex_normals(mesh_);
  triangle_normals_.resize(mesh_.triangles.size());
  std::vector<ClosedBox> boxes(mesh_.triangles.size());
  std::vector<char> kept(mesh_.triangles.size());
  tbb::parallel_for(std::size_t{0}, mesh_.triangles.size(), [&](std::size_t t) {
    triangle_normals_[t] = triangle_normal(mesh_, t);
    const Corners place = corners(static_cast<int>(t));
    boxes[t] = box_of(place);
    kept[t] = !has_no_area(place);
  });
  parts_.resize(at(part_count));
  parts_of_vertex_.resize(mesh_.vertices.size());
  std::vector<std::vector<ClosedBox>> of_part(parts_.size());
  bool any = false;
  for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
    const std::size_t k = at(part_of_triangle_[t]);
    for (const int v : mesh_.triangles[t]) parts_of_vertex_[at(v)] |= std::uint32_t{1} << k;
    if (!kept[t]) continue;
    parts_[k].triangles.push_back(static_cast<int>(t));
    of_part[k].push_back(boxes[t]);
    if (any) box_.extend(boxes[t]);
    if (!any) box_ = boxes[t];
    any = true;
  }
  if (!any) throw InputError("the mesh has no triangle with an area");
  for (std::size_t k = 0; k < parts_.size(); ++k) parts_[k].tree = BoxTree(of_part[k]);
}

Corners SolidSurface::corners(int triangle) const {
  const auto& [a, b, c] = mesh_.triangles[at(triangle)];
  return {mesh_.vertices[at(a)], mesh_.vertices[at(b)], mesh_.vertices[at(c)]};
}

std::array<double, 3> SolidSurface::barycentric(int triangle, const Point& p) const {
  const auto [a, b, c] = corners(triangle);
  const Eigen::Vector3d normal = (b - a).cross(c - a);
  const double area = normal.squaredNorm();
  const double of_a = (c - b).cross(p - b).dot(normal) / area, of_b = (a - c).cross(p - c).dot(normal) / area;
  return {of_a, of_b, 1 - of_a - of_b};
}

/// Not of unit length: of the triangle, edge or vertex that is nearest to p.
Eigen::Vector3d SolidSurface::normal_at(int triangle, const Point& p) const {
  const auto [a, b, c] = corners(triangle);
  const OnTriangle found = closest_on_triangle(p, a, b, c);
  if (found.where == OnTriangle::Where::corner)
    return vertex_normals_[at(mesh_.triangles[at(triangle)][at(found.feature)])];
  if (found.where == OnTriangle::Where::inside) return triangle_normals_[at(triangle)];
  return triangle_normals_[at(triangle)] + triangle_normals_[at(neighbours_[at(triangle)][at(found.feature)])];
}

std::optional<SignedDistance> SolidSurface::signed_distance(const Point& p, double within) const {
  constexpr double as_near = 1e-9;  // mm
  const ClosedBox here{{p.x(), p.y(), p.z()}, {p.x(), p.y(), p.z()}};
  // What is inside lies in the box, however far the surface is.
  if (box_.meets(here)) within = std::numeric_limits<double>::infinity();
  SignedDistance nearest;
  double distance = within;
  std::vector<double> of_part(parts_.size(), std::numeric_limits<double>::infinity());
  for (std::size_t k = 0; k < parts_.size(); ++k) {
    const double reach = distance + as_near;
    parts_[k].tree.visit_nearer(here, reach * reach, [&](int number, double bound) {
      const int t = parts_[k].triangles[at(number)];
      const auto [a, b, c] = corners(t);
      const OnTriangle found = closest_on_triangle(p, a, b, c);
      if (!(found.squared_distance < bound)) return bound;
      of_part[k] = std::sqrt(found.squared_distance);
      if (of_part[k] < distance) {
        distance = of_part[k];
        nearest.triangle = t;
        nearest.on_surface = found.point;
      }
      return found.squared_distance;
    });
  }
  if (nearest.triangle < 0) return std::nullopt;
  for (std::size_t k = 0; k < parts_.size(); ++k)
    if (of_part[k] <= distance + as_near) nearest.parts |= std::uint32_t{1} << k;
  const bool inside = normal_at(nearest.triangle, p).dot(p - nearest.on_surface) < 0;
  nearest.mm = inside ? -distance : distance;
  return nearest;
}

}  // namespace rhizodont
