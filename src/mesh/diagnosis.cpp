// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/diagnosis.hpp"

#include "base/disjoint_sets.hpp"
#include "mesh/adjacency.hpp"
#include "mesh/geometry.hpp"
#include "mesh/places.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace rhizodont {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

bool exactly_collinear(const Point& a, const Point& b, const Point& c) {
  return CGAL::collinear(Kernel::Point_3(a.x(), a.y(), a.z()), Kernel::Point_3(b.x(), b.y(), b.z()),
                         Kernel::Point_3(c.x(), c.y(), c.z()));
}

// The usable triangles, with their number in the mesh.
struct Usable {
  TriangleMesh mesh;
  std::vector<int> old_triangles;
};

Usable sort_out_indices(const TriangleMesh& mesh, Diagnosis& found) {
  Usable usable{{mesh.vertices, {}}, {}};
  const auto count = static_cast<std::int64_t>(mesh.vertices.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& c = mesh.triangles[t];
    if (std::any_of(c.begin(), c.end(), [&](std::int32_t v) { return v < 0 || v >= count; })) {
      found.out_of_range_triangles.push_back(static_cast<int>(t));
    } else if (c[0] == c[1] || c[1] == c[2] || c[2] == c[0]) {
      found.repeated_index_triangles.push_back(static_cast<int>(t));
    } else {
      usable.mesh.triangles.push_back(c);
      usable.old_triangles.push_back(static_cast<int>(t));
    }
  }
  return usable;
}

void find_duplicate_vertices(const TriangleMesh& mesh, Diagnosis& found) {
  std::vector<int> finite;
  std::vector<Point> points;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    if (!mesh.vertices[v].allFinite()) {
      found.non_finite_vertices.push_back(static_cast<int>(v));
      continue;
    }
    finite.push_back(static_cast<int>(v));
    points.push_back(mesh.vertices[v]);
  }
  const std::vector<int> first = first_at_place(points);
  for (std::size_t k = 0; k < finite.size(); ++k)
    if (first[k] != static_cast<int>(k)) found.duplicate_vertices.push_back(finite[k]);
}

void find_bad_triangles(const Usable& usable, Diagnosis& found) {
  const auto& [mesh, old_triangles] = usable;
  std::vector<std::pair<Triangle, int>> keys;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    Triangle key = mesh.triangles[t];
    const Point &a = mesh.vertices[static_cast<std::size_t>(key[0])],
                &b = mesh.vertices[static_cast<std::size_t>(key[1])],
                &c = mesh.vertices[static_cast<std::size_t>(key[2])];
    if (a.allFinite() && b.allFinite() && c.allFinite() && exactly_collinear(a, b, c))
      found.degenerate_triangles.push_back(old_triangles[t]);
    std::sort(key.begin(), key.end());
    keys.emplace_back(key, old_triangles[t]);
  }
  std::sort(keys.begin(), keys.end());
  for (std::size_t k = 1; k < keys.size(); ++k)
    if (keys[k].first == keys[k - 1].first) found.duplicate_triangles.push_back(keys[k].second);
  std::sort(found.duplicate_triangles.begin(), found.duplicate_triangles.end());
}

void find_bad_edges(const TriangleMesh& mesh, const EdgeTable& table, Diagnosis& found) {
  for (std::size_t e = 0; e < table.size(); ++e) {
    const int count = table.triangle_count(e);
    if (count == 1) found.border_edges.push_back(table.vertices[e]);
    if (count > 2) found.non_manifold_edges.push_back(table.vertices[e]);
    int upward = 0;
    for (int k = table.first[e]; k < table.first[e + 1]; ++k)
      upward += half_edge_from(mesh, table.half_edges[static_cast<std::size_t>(k)]) == table.vertices[e][0];
    const auto [a, b] = table.vertices[e];
    if (upward > 1) found.misoriented_edges.push_back({a, b});
    if (count - upward > 1) found.misoriented_edges.push_back({b, a});
  }
  std::sort(found.misoriented_edges.begin(), found.misoriented_edges.end());
}

// The triangles around v are one fan if the sides opposite to v hang together.
bool is_one_fan(const TriangleMesh& mesh, const VertexTriangles& around, int v) {
  std::vector<int> link;
  const auto begin = static_cast<std::size_t>(around.first[static_cast<std::size_t>(v)]);
  const auto end = static_cast<std::size_t>(around.first[static_cast<std::size_t>(v) + 1]);
  for (std::size_t k = begin; k < end; ++k)
    for (const int w : mesh.triangles[static_cast<std::size_t>(around.triangles[k])])
      if (w != v) link.push_back(w);
  std::vector<int> names = link;
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  const auto place = [&](int w) {
    return static_cast<int>(std::lower_bound(names.begin(), names.end(), w) - names.begin());
  };
  DisjointSets sets(names.size());
  std::size_t count = names.size();
  for (std::size_t k = 0; k < link.size(); k += 2) count -= sets.join(place(link[k]), place(link[k + 1])) ? 1 : 0;
  return count == 1;
}

void look_at_vertices(const TriangleMesh& mesh, Diagnosis& found) {
  const VertexTriangles around = vertex_triangles(mesh);
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    if (around.first[v] == around.first[v + 1])
      found.unreferenced_vertices.push_back(static_cast<int>(v));
    else if (!is_one_fan(mesh, around, static_cast<int>(v)))
      found.non_manifold_vertices.push_back(static_cast<int>(v));
  }
}

// Pieces of the graph that the given edges span (vertices without an edge do not count).
int count_pieces(std::size_t vertex_count, const std::vector<std::array<int, 2>>& edges) {
  DisjointSets sets(vertex_count);
  std::vector<bool> seen(vertex_count, false);
  int pieces = 0;
  for (const auto& edge : edges) {
    for (const int v : edge)
      if (!seen[static_cast<std::size_t>(v)]) seen[static_cast<std::size_t>(v)] = true, ++pieces;
    if (sets.join(edge[0], edge[1])) --pieces;
  }
  return pieces;
}

template <class Ids>
void describe(std::vector<std::string>& sentences, const Ids& ids, const char* what) {
  if (ids.empty()) return;
  constexpr std::size_t most = 5;
  const auto shown = std::min(ids.size(), most);
  sentences.push_back(fmt::format("{} {}: {}{}", ids.size(), what,
                                  fmt::join(ids.begin(), ids.begin() + static_cast<std::ptrdiff_t>(shown), ", "),
                                  ids.size() > most ? ", ..." : ""));
}

}  // namespace

bool Diagnosis::is_valid() const {
  return non_finite_vertices.empty() && out_of_range_triangles.empty() && repeated_index_triangles.empty();
}

bool Diagnosis::is_oriented_manifold() const {
  return is_valid() && triangles > 0 && non_manifold_edges.empty() && misoriented_edges.empty() &&
         non_manifold_vertices.empty() && duplicate_triangles.empty();
}

bool Diagnosis::is_closed_manifold() const { return is_oriented_manifold() && border_edges.empty(); }

bool Diagnosis::is_closed_solid() const {
  return is_closed_manifold() && components == 1 && genus == 0 && volume > 0 && unreferenced_vertices.empty() &&
         duplicate_vertices.empty();
}

Diagnosis diagnose(const TriangleMesh& mesh) {
  Diagnosis found;
  const Usable usable = sort_out_indices(mesh, found);
  find_duplicate_vertices(mesh, found);
  find_bad_triangles(usable, found);
  const EdgeTable table = edge_table(usable.mesh);
  find_bad_edges(usable.mesh, table, found);
  look_at_vertices(usable.mesh, found);
  found.vertices = static_cast<int>(mesh.vertices.size() - found.unreferenced_vertices.size());
  found.edges = static_cast<int>(table.size());
  found.triangles = static_cast<int>(usable.mesh.triangles.size());
  found.components = count_pieces(mesh.vertices.size(), table.vertices);
  found.border_loop_count = count_pieces(mesh.vertices.size(), found.border_edges);
  found.euler_number = found.vertices - found.edges + found.triangles;
  if (found.is_closed_manifold()) found.genus = found.components - found.euler_number / 2;
  if (found.non_finite_vertices.empty()) found.volume = volume(usable.mesh);
  return found;
}

std::vector<std::string> describe_defects(const Diagnosis& found) {
  std::vector<std::string> sentences;
  describe(sentences, found.non_finite_vertices, "vertices with coordinates that are not finite numbers");
  describe(sentences, found.out_of_range_triangles, "triangles that refer to vertices that do not exist");
  describe(sentences, found.repeated_index_triangles, "triangles with the same vertex twice");
  describe(sentences, found.degenerate_triangles, "triangles without area");
  describe(sentences, found.duplicate_triangles, "triangles that are there twice");
  describe(sentences, found.duplicate_vertices, "vertices at the place of another vertex");
  describe(sentences, found.unreferenced_vertices, "vertices that no triangle uses");
  describe(sentences, found.non_manifold_edges, "edges with more than two triangles");
  describe(sentences, found.misoriented_edges, "edges where neighbouring triangles face opposite ways");
  describe(sentences, found.non_manifold_vertices, "vertices where the surface touches itself");
  return sentences;
}

}  // namespace rhizodont
