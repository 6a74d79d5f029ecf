// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Vertex normals: G. Thuermer, C. Wuethrich, "Computing vertex normals from polygonal facets", JGT 3(1), 1998.
#include "mesh/geometry.hpp"

#include "mesh/adjacency.hpp"
#include "rhizodont/error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rhizodont {
namespace {

const Point& corner(const TriangleMesh& mesh, std::size_t triangle, std::size_t i) {
  return mesh.vertices[static_cast<std::size_t>(mesh.triangles[triangle][i])];
}

// atan2 stays accurate for needles, where the law of cosines loses all digits.
double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

}  // namespace

Eigen::Vector3d triangle_area_vector(const TriangleMesh& mesh, std::size_t triangle) {
  const Point& a = corner(mesh, triangle, 0);
  return 0.5 * (corner(mesh, triangle, 1) - a).cross(corner(mesh, triangle, 2) - a);
}

double triangle_area(const TriangleMesh& mesh, std::size_t triangle) {
  return triangle_area_vector(mesh, triangle).norm();
}

Eigen::Vector3d triangle_normal(const TriangleMesh& mesh, std::size_t triangle) {
  const Eigen::Vector3d area = triangle_area_vector(mesh, triangle);
  // stableNorm: the product of two short edges must not underflow to "no area"
  const double length = area.stableNorm();
  return length > 0 ? Eigen::Vector3d(area / length) : Eigen::Vector3d::Zero();
}

std::array<double, 3> triangle_angles(const TriangleMesh& mesh, std::size_t triangle) {
  std::array<double, 3> angles{};
  for (std::size_t i = 0; i < 3; ++i) {
    const Point& p = corner(mesh, triangle, i);
    angles[i] = angle_between(corner(mesh, triangle, (i + 1) % 3) - p, corner(mesh, triangle, (i + 2) % 3) - p);
  }
  return angles;
}

Eigen::Vector3d area_vector(const TriangleMesh& mesh) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) sum += triangle_area_vector(mesh, t);
  return sum;
}

namespace {

double cone_from(const Point& apex, const TriangleMesh& mesh) {
  double sum = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    sum += triangle_area_vector(mesh, t).dot(corner(mesh, t, 0) - apex) / 3;
  return sum;
}

}  // namespace

double volume(const TriangleMesh& mesh) {
  return mesh.vertices.empty() ? 0 : cone_from(bounding_box(mesh.vertices).center(), mesh);
}

double cone_volume(const TriangleMesh& mesh) {
  const EdgeTable table = edge_table(mesh);
  Point sum = Point::Zero();
  int ends = 0;
  for (std::size_t e = 0; e < table.size(); ++e) {
    if (table.triangle_count(e) != 1) continue;
    for (const int v : table.vertices[e]) sum += mesh.vertices[static_cast<std::size_t>(v)];
    ends += 2;
  }
  return ends == 0 ? volume(mesh) : cone_from(sum / ends, mesh);
}

double surface_area(const TriangleMesh& mesh) {
  double sum = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) sum += triangle_area(mesh, t);
  return sum;
}

namespace {

/// Adds up the triangles' normals at their corners v, weighted, in sums[place(v)] where that is not negative.
template <class Place>
void add_corner_normals(const TriangleMesh& mesh, const Place& place, std::vector<Eigen::Vector3d>& sums) {
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& c = mesh.triangles[t];
    if (place(c[0]) < 0 && place(c[1]) < 0 && place(c[2]) < 0) continue;
    const Eigen::Vector3d normal = triangle_normal(mesh, t);
    const std::array<double, 3> angles = triangle_angles(mesh, t);
    for (std::size_t i = 0; i < 3; ++i)
      if (place(c[i]) >= 0) sums[static_cast<std::size_t>(place(c[i]))] += angles[i] * normal;
  }
  for (Eigen::Vector3d& sum : sums) {
    const double length = sum.norm();
    if (length > 0) sum /= length;
  }
}

}  // namespace

std::vector<Eigen::Vector3d> vertex_normals(const TriangleMesh& mesh) {
  std::vector<Eigen::Vector3d> normals(mesh.vertices.size(), Eigen::Vector3d::Zero());
  add_corner_normals(
      mesh, [](int v) { return v; }, normals);
  return normals;
}

std::vector<Eigen::Vector3d> vertex_normals_at(const TriangleMesh& mesh, const std::vector<int>& vertices) {
  std::vector<int> place(mesh.vertices.size(), -1);
  for (std::size_t k = 0; k < vertices.size(); ++k) place[static_cast<std::size_t>(vertices[k])] = static_cast<int>(k);
  std::vector<Eigen::Vector3d> normals(vertices.size(), Eigen::Vector3d::Zero());
  add_corner_normals(
      mesh, [&](int v) { return place[static_cast<std::size_t>(v)]; }, normals);
  for (std::size_t k = 0; k < vertices.size(); ++k)
    normals[k] = normals[static_cast<std::size_t>(place[static_cast<std::size_t>(vertices[k])])];
  return normals;
}

Eigen::AlignedBox3d bounding_box(const std::vector<Point>& points) {
  Eigen::AlignedBox3d box;
  for (const Point& point : points) box.extend(point);
  return box;
}

std::pair<double, double> extent_along(const std::vector<Point>& points, const Eigen::Vector3d& axis) {
  double low = std::numeric_limits<double>::max();
  double high = std::numeric_limits<double>::lowest();
  for (const Point& p : points) {
    low = std::min(low, p.dot(axis));
    high = std::max(high, p.dot(axis));
  }
  return {low, high};
}

double mean_edge_length(const TriangleMesh& mesh) {
  const EdgeTable table = edge_table(mesh);
  if (table.size() == 0) return 0;
  double sum = 0;
  for (const auto& [a, b] : table.vertices)
    sum += (mesh.vertices[static_cast<std::size_t>(a)] - mesh.vertices[static_cast<std::size_t>(b)]).norm();
  return sum / static_cast<double>(table.size());
}

Point area_centroid(const TriangleMesh& mesh) {
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  double area = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const double part = triangle_area(mesh, t);
    area += part;
    moment += part / 3 * (corner(mesh, t, 0) + corner(mesh, t, 1) + corner(mesh, t, 2));
  }
  if (!(area > 0)) throw InputError("the mesh has no surface area");
  return moment / area;
}

}  // namespace rhizodont
