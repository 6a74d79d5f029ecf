// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/adjacency.hpp"

#include "base/disjoint_sets.hpp"
#include "mesh/geometry.hpp"
#include "mesh/mesh_checks.hpp"
#include "rhizodont/error.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

namespace rhizodont {
namespace {

struct EdgeKey {
  std::uint64_t ends;  // lower vertex in the high half, so that sorting is lexicographic
  int half_edge;
  friend bool operator<(const EdgeKey& a, const EdgeKey& b) {
    return a.ends != b.ends ? a.ends < b.ends : a.half_edge < b.half_edge;
  }
};

/// First those of the lowest vertex, and so on: counted, since a vertex has but a few and sorting all takes long.
std::vector<EdgeKey> sorted_half_edges(const TriangleMesh& mesh) {
  const int count = static_cast<int>(3 * mesh.triangles.size());
  const auto lower_end = [&](int h) {
    return static_cast<std::size_t>(std::min(half_edge_from(mesh, h), half_edge_to(mesh, h)));
  };
  std::vector<std::size_t> end(mesh.vertices.size() + 1,
                               0);  // per vertex where its edges begin, at last where they end
  for (int h = 0; h < count; ++h) ++end[lower_end(h) + 1];
  std::partial_sum(end.begin(), end.end(), end.begin());
  std::vector<EdgeKey> keys(static_cast<std::size_t>(count));
  for (int h = 0; h < count; ++h) {
    const std::size_t lower = lower_end(h);
    const auto higher = static_cast<std::uint64_t>(std::max(half_edge_from(mesh, h), half_edge_to(mesh, h)));
    keys[end[lower]++] = {std::uint64_t{lower} << 32 | higher, h};
  }
  std::size_t begin = 0;
  for (std::size_t v = 0; v < mesh.vertices.size(); begin = end[v++])
    std::sort(keys.begin() + static_cast<std::ptrdiff_t>(begin), keys.begin() + static_cast<std::ptrdiff_t>(end[v]));
  return keys;
}

struct BorderWalk {
  std::vector<int> next;                // of a border vertex along its outgoing border half-edge; -1 elsewhere
  std::vector<std::int64_t> branching;  // vertices that do not have exactly one border half-edge in and one out
};

BorderWalk border_walk(const TriangleMesh& mesh) {
  const EdgeTable table = edge_table(mesh);
  BorderWalk walk{std::vector<int>(mesh.vertices.size(), -1), {}};
  std::vector<int> out(mesh.vertices.size(), 0), in(mesh.vertices.size(), 0);
  for (std::size_t e = 0; e < table.size(); ++e) {
    if (table.triangle_count(e) != 1) continue;
    const int h = table.half_edges[static_cast<std::size_t>(table.first[e])];
    const auto from = static_cast<std::size_t>(half_edge_from(mesh, h));
    const auto to = static_cast<std::size_t>(half_edge_to(mesh, h));
    walk.next[from] = static_cast<int>(to);
    ++out[from];
    ++in[to];
  }
  for (std::size_t v = 0; v < out.size(); ++v)
    if (out[v] > 1 || in[v] > 1 || out[v] != in[v]) walk.branching.push_back(static_cast<std::int64_t>(v));
  return walk;
}

}  // namespace

EdgeTable edge_table(const TriangleMesh& mesh) {
  require_valid_indices(mesh);
  const std::vector<EdgeKey> keys = sorted_half_edges(mesh);
  EdgeTable table;
  table.half_edges.reserve(keys.size());
  table.vertices.reserve(keys.size() / 2 + 1);
  for (std::size_t k = 0; k < keys.size(); ++k) {
    if (k == 0 || keys[k].ends != keys[k - 1].ends) {
      table.first.push_back(static_cast<int>(k));
      table.vertices.push_back({static_cast<int>(keys[k].ends >> 32), static_cast<int>(keys[k].ends & 0xffffffffU)});
    }
    table.half_edges.push_back(keys[k].half_edge);
  }
  table.first.push_back(static_cast<int>(keys.size()));
  return table;
}

TriangleAdjacency triangle_adjacency(const TriangleMesh& mesh) {
  const EdgeTable table = edge_table(mesh);
  TriangleAdjacency adjacency;
  adjacency.neighbours.assign(mesh.triangles.size(), {-1, -1, -1});
  std::vector<std::int64_t> crowded;
  for (std::size_t e = 0; e < table.size(); ++e) {
    if (table.triangle_count(e) > 2) {
      crowded.insert(crowded.end(), table.vertices[e].begin(), table.vertices[e].end());
    } else if (table.triangle_count(e) == 2) {
      const auto first = static_cast<std::size_t>(table.first[e]);
      const int g = table.half_edges[first], h = table.half_edges[first + 1];
      adjacency.neighbours[static_cast<std::size_t>(g / 3)][static_cast<std::size_t>(g % 3)] = h / 3;
      adjacency.neighbours[static_cast<std::size_t>(h / 3)][static_cast<std::size_t>(h % 3)] = g / 3;
    }
  }
  if (!crowded.empty())
    throw InputError("edges with more than two triangles (the two vertices of each follow)", crowded,
                     ElementKind::vertex_pairs);
  return adjacency;
}

VertexTriangles vertex_triangles(const TriangleMesh& mesh) {
  require_valid_indices(mesh);
  VertexTriangles around;
  around.first.assign(mesh.vertices.size() + 1, 0);
  for (const Triangle& triangle : mesh.triangles)
    for (const int v : triangle) ++around.first[static_cast<std::size_t>(v) + 1];
  std::partial_sum(around.first.begin(), around.first.end(), around.first.begin());
  around.triangles.resize(3 * mesh.triangles.size());
  std::vector<int> place(around.first.begin(), around.first.end() - 1);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const int v : mesh.triangles[t])
      around.triangles[static_cast<std::size_t>(place[static_cast<std::size_t>(v)]++)] = static_cast<int>(t);
  return around;
}

double edge_bend(const TriangleMesh& mesh, const EdgeTable& table, std::size_t edge) {
  if (table.triangle_count(edge) != 2) return 0;
  const auto [a, b] = table.vertices[edge];
  const Eigen::Vector3d along = mesh.vertices[static_cast<std::size_t>(b)] - mesh.vertices[static_cast<std::size_t>(a)];
  const auto at = static_cast<std::size_t>(table.first[edge]);
  const int g = table.half_edges[at], h = table.half_edges[at + 1];
  const Eigen::Vector3d first = triangle_normal(mesh, static_cast<std::size_t>(half_edge_triangle(g)));
  const Eigen::Vector3d second = triangle_normal(mesh, static_cast<std::size_t>(half_edge_triangle(h)));
  if (first.isZero() || second.isZero()) return 0;
  const Eigen::Vector3d into_first = (half_edge_from(mesh, g) == a ? 1 : -1) * first.cross(along).normalized();
  return std::atan2(-second.dot(into_first), second.dot(first));
}

std::vector<std::vector<int>> border_loops(const TriangleMesh& mesh) {
  const BorderWalk walk = border_walk(mesh);
  if (!walk.branching.empty())
    throw InputError(
        "the border touches itself, or triangles beside it face opposite ways, at some vertices (numbers follow)",
        walk.branching, ElementKind::vertices);
  std::vector<std::vector<int>> loops;
  std::vector<bool> seen(mesh.vertices.size(), false);
  for (std::size_t start = 0; start < mesh.vertices.size(); ++start) {
    if (walk.next[start] < 0 || seen[start]) continue;
    std::vector<int>& loop = loops.emplace_back();
    for (int v = static_cast<int>(start); !seen[static_cast<std::size_t>(v)];
         v = walk.next[static_cast<std::size_t>(v)]) {
      seen[static_cast<std::size_t>(v)] = true;
      loop.push_back(v);
    }
  }
  return loops;
}

ConnectedComponents connected_components(const TriangleMesh& mesh) {
  const EdgeTable table = edge_table(mesh);
  DisjointSets sets(mesh.triangles.size());
  for (std::size_t e = 0; e < table.size(); ++e)
    for (int k = table.first[e] + 1; k < table.first[e + 1]; ++k)
      sets.join(table.half_edges[static_cast<std::size_t>(k)] / 3,
                table.half_edges[static_cast<std::size_t>(k - 1)] / 3);
  ConnectedComponents components;
  components.of_triangle.resize(mesh.triangles.size());
  std::vector<int> number(mesh.triangles.size(), -1);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    int& root_number = number[static_cast<std::size_t>(sets.find(static_cast<int>(t)))];
    if (root_number < 0) root_number = components.count++;
    components.of_triangle[t] = root_number;
  }
  return components;
}

Submesh submesh(const TriangleMesh& mesh, const std::vector<bool>& mask) {
  require_valid_indices(mesh);
  if (mask.size() != mesh.triangles.size()) throw UsageError("a triangle mask needs one entry per triangle");
  std::vector<int> place(mesh.vertices.size(), -1);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (mask[t])
      for (const int v : mesh.triangles[t]) place[static_cast<std::size_t>(v)] = 0;
  Submesh part;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    if (place[v] < 0) continue;
    place[v] = static_cast<int>(part.old_vertices.size());
    part.old_vertices.push_back(static_cast<int>(v));
    part.mesh.vertices.push_back(mesh.vertices[v]);
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (!mask[t]) continue;
    Triangle& triangle = part.mesh.triangles.emplace_back(mesh.triangles[t]);
    for (std::int32_t& v : triangle) v = place[static_cast<std::size_t>(v)];
    part.old_triangles.push_back(static_cast<int>(t));
  }
  return part;
}

Submesh compact(const TriangleMesh& mesh) { return submesh(mesh, std::vector<bool>(mesh.triangles.size(), true)); }

TriangleMesh flipped(const TriangleMesh& mesh) {
  TriangleMesh turned = mesh;
  for (Triangle& triangle : turned.triangles) std::swap(triangle[1], triangle[2]);
  return turned;
}

}  // namespace rhizodont
