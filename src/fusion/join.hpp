// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"
#include "voronoi/delaunay_mesh.hpp"
#include "voronoi/restricted_voronoi.hpp"

#include <vector>

namespace rhizodont {

struct JoinOptions {
  DelaunayMeshOptions delaunay;      ///< how the crown is made a Delaunay mesh
  RestrictedVoronoiOptions voronoi;  ///< how the restricted Voronoi diagram is computed
  double least_distance = 2e-3;      ///< relative to the crown's mean edge length, >= 0: sites nearer than this to an
                                     ///< earlier one get no cell. Cells as thin as needle triangles cost exact
                                     ///< arithmetic and meet nothing but each other
};

/// Throws UsageError for an option out of its range.
void require_in_range(const JoinOptions& options);

/// Crown and root joined as the dual of a restricted Voronoi diagram. Sites are numbered: the crown's vertices in their
/// order, then the Steiner points that made the crown a Delaunay mesh, then the root vertices.
struct Joining {
  std::vector<Point> sites;
  std::vector<Triangle> triangles;  ///< the dual without repetitions, over the sites
  int crown_vertices = 0;           ///< sites [0, crown_vertices)
  int steiner_points = 0;           ///< sites [crown_vertices, crown_vertices + steiner_points)
  int crown_triangles_direct = 0;   ///< crown triangles all of whose pieces are in the dual
  std::vector<bool> crown_in_dual;  ///< per crown triangle
  int non_delaunay_edges_left = 0;  ///< see DelaunayMesh::edges_left
  std::vector<bool> in_diagram;     ///< per site: false if it was left out because another one crowds it
  int sites_without_cell = 0;       ///< left out, or their cells do not meet the guiding surface
};

/// Joins the crown with root vertices on the guiding surface (paper, 3.5): the crown is made a Delaunay mesh with
/// Steiner points on edges, the Voronoi diagram of its vertices and the root vertices is restricted to the guiding
/// surface, and its dual is taken. Throws what `make_delaunay_mesh` and `restricted_voronoi` throw.
Joining join_crown_and_root(const TriangleMesh& crown, const std::vector<Point>& root_vertices,
                            const TriangleMesh& guiding_surface, const JoinOptions& options = {});

/// The same for a crown that was made a Delaunay mesh before, by `make_delaunay_mesh(crown, options.delaunay)`: for
/// who tries several roots.
Joining join_crown_and_root(const TriangleMesh& crown, const DelaunayMesh& delaunay,
                            const std::vector<Point>& root_vertices, const TriangleMesh& guiding_surface,
                            const JoinOptions& options = {});

}  // namespace rhizodont
