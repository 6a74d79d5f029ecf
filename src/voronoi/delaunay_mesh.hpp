// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

#include <array>
#include <vector>

namespace rhizodont {

struct DelaunayMeshOptions {
  double angle_slack = 1e-9;     ///< how far cot(alpha) + cot(beta) may lie below 0 at a Delaunay edge, >= 0
  double shortest_piece = 1e-6;  ///< relative to the mesh's mean edge length, >= 0: shorter pieces are not split
  double steiner_limit = 8.0;    ///< at most this many Steiner points per input vertex, >= 0
};

/// Throws UsageError for an option out of its range.
void require_in_range(const DelaunayMeshOptions& options);

/// A mesh made Delaunay by Steiner points on its edges; the surface is the same, the first vertices are the input's.
struct DelaunayMesh {
  TriangleMesh mesh;
  std::vector<int> parent_triangle;               ///< per triangle: the input triangle that it lies in
  std::vector<std::array<int, 2>> steiner_edges;  ///< per added vertex: the input edge (lower, higher vertex) it is on
  int edges_left = 0;                             ///< interior edges that could not be made Delaunay within the limits
};

/// Ends (lower, higher vertex) of the interior edges whose opposite angles sum to more than pi, sorted. With
/// `angle_slack` = 0 the answer is exact for the coordinates as they are; else it is for cot(alpha) + cot(beta) <
/// -angle_slack, rounded, which lets pass what is Delaunay but for the rounding of its Steiner points.
/// Precondition: every edge has one or two triangles (else InputError). A triangle without area has angles of 0 and pi.
std::vector<std::array<int, 2>> non_delaunay_edges(const TriangleMesh& mesh, double angle_slack = 1e-9);

/// Adds Steiner points on edges until the mesh is a Delaunay mesh: edges inside an input triangle are flipped, others
/// are halved, cut at radii around their ends that all edges have in common, or, if seen under more than 150 degrees,
/// at the foot of the apex that sees them so. Border edges stay whole. Without the limits in `options` the process
/// ends, too, within the bounds of `steiner_bounds`. Paper, sections 3.5 and 3.6; Y.-J. Liu et al., "Efficient
/// construction and simplification of Delaunay meshes", 2015. Throws InputError where an edge has more than two
/// triangles or two that are turned against each other.
DelaunayMesh make_delaunay_mesh(const TriangleMesh& mesh, const DelaunayMeshOptions& options = {});

/// What is certain beforehand of the Steiner points that `make_delaunay_mesh` adds. They are far fewer in practice.
struct SteinerBounds {
  double shortest_edge = 0;   ///< mm
  double smallest_angle = 0;  ///< radians
  double end_gap = 0;         ///< mm: none is nearer to the ends of its edge (rho_v of the paper, 3.6)
  double inner_gap = 0;       ///< mm: no two on an edge are nearer to each other (rho_e)
  double most_points = 0;     ///< on all interior edges together, infinite if a triangle has no area
};
/// Throws InputError for a mesh without triangles.
SteinerBounds steiner_bounds(const TriangleMesh& mesh);

/// Which triangles of `input` a dual gives, per triangle of the input: those over whose pieces in `delaunay`, made of
/// `input`, the dual's triangles lie one by one; or whose outline they fill in another way. Pieces of one triangle lie
/// in its plane and often on a common circle, so that their diagonals are a matter of rounding.
/// `dual`: sorted, each with its lowest index first; its first sites are the vertices of `delaunay.mesh`.
std::vector<bool> triangles_given_by_dual(const TriangleMesh& input, const DelaunayMesh& delaunay,
                                          const std::vector<Triangle>& dual);

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
