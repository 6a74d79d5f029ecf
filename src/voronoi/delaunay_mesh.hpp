// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

#include <array>
#include <vector>

namespace rhizodont {

struct DelaunayMeshOptions {
  double angle_slack = 1e-9;     ///< how far cot(alpha) + cot(beta) may lie below 0 at a Delaunay edge, >= 0
  double shortest_piece = 0.02;  ///< relative to the mesh's mean edge length: shorter pieces of an edge are not split
  double steiner_limit = 4.0;    ///< at most this many Steiner points per input vertex, >= 0
};

/// A mesh made Delaunay by Steiner points on its edges; the surface is the same, the first vertices are the input's.
struct DelaunayMesh {
  TriangleMesh mesh;
  std::vector<int> parent_triangle;               ///< per triangle: the input triangle that it lies in
  std::vector<std::array<int, 2>> steiner_edges;  ///< per added vertex: the input edge (lower, higher vertex) it is on
  int edges_left = 0;                             ///< interior edges that could not be made Delaunay within the limits
};

/// Ends (lower, higher vertex) of the interior edges whose opposite angles sum to more than pi, sorted.
/// Precondition: every edge has one or two triangles (else InputError). Degenerate triangles count as not Delaunay.
std::vector<std::array<int, 2>> non_delaunay_edges(const TriangleMesh& mesh, double angle_slack = 1e-9);

/// Adds Steiner points on edges until the mesh is a Delaunay mesh: edges inside an input triangle are flipped, others
/// are split near the foot of the apex that sees them under the larger angle, at dyadic fractions of the input edge, so
/// that pieces of edges sharing a vertex keep comparable lengths and the process ends. Border edges stay whole.
/// Paper, sections 3.5 and 3.6; Y.-J. Liu et al., "Efficient construction and simplification of Delaunay meshes", 2015.
/// Throws InputError where an edge has more than two triangles or two that are turned against each other.
DelaunayMesh make_delaunay_mesh(const TriangleMesh& mesh, const DelaunayMeshOptions& options = {});

/// Whether a mesh is its own restricted Delaunay triangulation, per triangle.
struct StrongDelaunay {
  std::vector<bool> triangle_in_dual;  ///< per triangle of the mesh: found again in the dual
  int missing = 0;                     ///< triangles of the mesh that the dual lacks
  int additional = 0;                  ///< triangles of the dual that the mesh lacks
  bool holds() const { return missing == 0 && additional == 0; }
};

/// Tests the paper's definition (3.5): the dual of the Voronoi diagram of the vertices restricted to the mesh itself.
StrongDelaunay test_strong_delaunay(const TriangleMesh& mesh);

}  // namespace rhizodont
