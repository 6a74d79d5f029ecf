// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// T. Boubekeur and M. Alexa, "Phong tessellation", ACM Transactions on Graphics 27(5), 2008: where new vertices lie.

#include "common/hostile_crowns.hpp"

#include "mesh/adjacency.hpp"
#include "mesh/border_pieces.hpp"
#include "mesh/geometry.hpp"
#include "mesh/surface_mesh.hpp"

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Count_ratio_stop_predicate.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>

#include <algorithm>
#include <numeric>

namespace rhizodont::test {
namespace {

/// The middle of an edge on the surface that bends as its ends' normals say.
Point middle_on_curve(const Point& a, const Eigen::Vector3d& normal_a, const Point& b,
                      const Eigen::Vector3d& normal_b) {
  const Point middle = 0.5 * (a + b);
  const Point on_a = middle - (middle - a).dot(normal_a) * normal_a;
  const Point on_b = middle - (middle - b).dot(normal_b) * normal_b;
  return 0.25 * middle + 0.75 * 0.5 * (on_a + on_b);
}

/// The pieces of a triangle whose edges have the given middles (-1: whole).
void append_pieces(const Triangle& t, const std::array<int, 3>& middle, std::vector<Triangle>& pieces) {
  const auto marked = std::count_if(middle.begin(), middle.end(), [](int m) { return m >= 0; });
  if (marked == 0) return pieces.push_back(t);
  if (marked == 3) {
    for (std::size_t i = 0; i < 3; ++i) pieces.push_back({t[i], middle[i], middle[(i + 2) % 3]});
    return pieces.push_back({middle[0], middle[1], middle[2]});
  }
  // Turned so that the edge (a, b) is split and, of two, the one after it too.
  std::size_t i = 0;
  while (middle[i] < 0 || (marked == 2 && middle[(i + 1) % 3] < 0)) ++i;
  const int a = t[i], b = t[(i + 1) % 3], c = t[(i + 2) % 3], m = middle[i], n = middle[(i + 1) % 3];
  pieces.push_back({a, m, c});
  if (marked == 1) return pieces.push_back({m, b, c});
  pieces.push_back({m, b, n});
  pieces.push_back({m, n, c});
}

/// Splits the `count` longest edges, but none shorter than 0.6 of the longest.
TriangleMesh split_longest(const TriangleMesh& mesh, std::size_t count) {
  const EdgeTable edges = edge_table(mesh);
  const auto at = [&](int v) -> const Point& { return mesh.vertices[static_cast<std::size_t>(v)]; };
  std::vector<double> length(edges.size());
  for (std::size_t e = 0; e < edges.size(); ++e)
    length[e] = (at(edges.vertices[e][0]) - at(edges.vertices[e][1])).norm();
  std::vector<std::size_t> order(edges.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t x, std::size_t y) { return length[x] > length[y]; });
  const std::vector<Eigen::Vector3d> normals = vertex_normals(mesh);
  std::vector<std::array<int, 3>> middles(mesh.triangles.size(), {-1, -1, -1});
  TriangleMesh finer{mesh.vertices, {}};
  for (std::size_t k = 0; k < std::min(count, order.size()) && length[order[k]] >= 0.6 * length[order[0]]; ++k) {
    const std::size_t e = order[k];
    const auto a = static_cast<std::size_t>(edges.vertices[e][0]), b = static_cast<std::size_t>(edges.vertices[e][1]);
    const int middle = static_cast<int>(finer.vertices.size());
    finer.vertices.push_back(middle_on_curve(mesh.vertices[a], normals[a], mesh.vertices[b], normals[b]));
    for (int h = edges.first[e]; h < edges.first[e + 1]; ++h) {
      const int half_edge = edges.half_edges[static_cast<std::size_t>(h)];
      middles[static_cast<std::size_t>(half_edge / 3)][static_cast<std::size_t>(half_edge % 3)] = middle;
    }
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) append_pieces(mesh.triangles[t], middles[t], finer.triangles);
  return finer;
}

}  // namespace

TriangleMesh refined_to(TriangleMesh mesh, std::size_t vertices) {
  while (mesh.vertices.size() < vertices) mesh = split_longest(mesh, vertices - mesh.vertices.size());
  return mesh;
}

TriangleMesh coarsened_to(const TriangleMesh& mesh, std::size_t vertices) {
  if (vertices >= mesh.vertices.size()) return mesh;
  namespace simplification = CGAL::Surface_mesh_simplification;
  SurfaceMesh surface = to_surface_mesh(mesh);
  const double share = static_cast<double>(vertices) / static_cast<double>(mesh.vertices.size());
  simplification::edge_collapse(surface, simplification::Count_ratio_stop_predicate<SurfaceMesh>(share));
  surface.collect_garbage();
  TriangleMesh coarser;
  for (const auto v : surface.vertices()) coarser.vertices.push_back(to_point(surface.point(v)));
  for (const auto f : surface.faces()) coarser.triangles.push_back(to_triangle(surface, f));
  return coarser;
}

TriangleMesh resized_to(const TriangleMesh& mesh, std::size_t vertices) {
  return vertices < mesh.vertices.size() ? coarsened_to(mesh, vertices) : refined_to(mesh, vertices);
}

TriangleMesh capped(const TriangleMesh& crown) {
  const std::vector<BorderPiece> border = border_pieces(crown);
  const BorderPiece& base = border[base_piece(border)];
  TriangleMesh closed = crown;
  Point centre = Point::Zero();
  for (const int v : base.vertices) centre += crown.vertices[static_cast<std::size_t>(v)];
  const auto apex = static_cast<std::int32_t>(closed.vertices.size());
  closed.vertices.push_back(centre / static_cast<double>(base.vertices.size()));
  for (const auto& [a, b] : base.half_edges) closed.triangles.push_back({b, a, apex});
  return closed;
}

}  // namespace rhizodont::test
