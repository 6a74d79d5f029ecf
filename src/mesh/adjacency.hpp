// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

#include <array>
#include <vector>

namespace rhizodont {

/// Half-edge h = 3 t + i of triangle t runs from its corner i to its corner (i + 1) % 3.
inline int half_edge_triangle(int half_edge) { return half_edge / 3; }
inline int half_edge_from(const TriangleMesh& mesh, int half_edge) {
  return mesh.triangles[static_cast<std::size_t>(half_edge / 3)][static_cast<std::size_t>(half_edge % 3)];
}
inline int half_edge_to(const TriangleMesh& mesh, int half_edge) {
  return mesh.triangles[static_cast<std::size_t>(half_edge / 3)][static_cast<std::size_t>((half_edge + 1) % 3)];
}

/// All undirected edges of a mesh, sorted by (lower vertex, higher vertex), with the half-edges on each.
struct EdgeTable {
  std::vector<std::array<int, 2>> vertices;  ///< per edge: lower, higher vertex
  std::vector<int> first;                    ///< half-edges of edge e: half_edges[first[e] .. first[e + 1])
  std::vector<int> half_edges;               ///< ascending within one edge

  std::size_t size() const { return vertices.size(); }
  int triangle_count(std::size_t edge) const { return first[edge + 1] - first[edge]; }
};

/// Precondition: three different indices in range per triangle.
/// Throws InputError (ids of the triangles) if an index is out of range.
EdgeTable edge_table(const TriangleMesh& mesh);

/// Neighbours over edges in a mesh whose every edge has one or two triangles.
struct TriangleAdjacency {
  /// neighbours[t][i]: the triangle over the edge from corner i to corner (i + 1) % 3 of t; -1 at a border.
  std::vector<std::array<int, 3>> neighbours;
};

/// Throws InputError, with the end vertices of each offending edge (two ids per edge), where an edge has more
/// than two triangles. The orientation of the two triangles at an edge need not agree.
TriangleAdjacency triangle_adjacency(const TriangleMesh& mesh);

/// Triangles around each vertex, ascending.
struct VertexTriangles {
  std::vector<int> first;      ///< triangles of vertex v: triangles[first[v] .. first[v + 1])
  std::vector<int> triangles;  ///< ids
};

/// Throws InputError (ids of the triangles) if an index is out of range.
VertexTriangles vertex_triangles(const TriangleMesh& mesh);

/// How much the surface is bent at an edge of the table, radians, -pi to pi: positive outwards (a ridge), negative
/// inwards (a crease), 0 where the edge has not just two triangles or one of them has no area.
double edge_bend(const TriangleMesh& mesh, const EdgeTable& table, std::size_t edge);

/// The closed loops of border vertices; in each, consecutive vertices (and last to first) are a half-edge of the
/// triangle beside it, so the mesh lies to the left when seen from outside. Each loop starts at its lowest vertex;
/// loops are sorted by that vertex. Empty for a closed mesh.
/// Throws InputError with the vertices where loops touch or where the triangles on a border are turned against each
/// other.
std::vector<std::vector<int>> border_loops(const TriangleMesh& mesh);

/// Pieces of a mesh. Triangles belong together if they share an edge (a vertex alone does not join).
struct ConnectedComponents {
  std::vector<int> of_triangle;  ///< component of each triangle, numbered by first appearance
  int count = 0;
};
ConnectedComponents connected_components(const TriangleMesh& mesh);

/// A part of a mesh, with where each element was before. Order is kept.
struct Submesh {
  TriangleMesh mesh;
  std::vector<int> old_vertices;   ///< index in the whole mesh of each vertex of the part, ascending
  std::vector<int> old_triangles;  ///< likewise for triangles
};

/// The mesh without unreferenced vertices.
Submesh compact(const TriangleMesh& mesh);

/// The triangles with a true entry in `mask` (as many entries as triangles), with the vertices they use.
Submesh submesh(const TriangleMesh& mesh, const std::vector<bool>& mask);

/// Copy with every triangle turned around (second and third index swapped).
TriangleMesh flipped(const TriangleMesh& mesh);

}  // namespace rhizodont
