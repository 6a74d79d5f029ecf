// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// "Completing Dental Models While Preserving Crown Geometry and Meshing Topology", section 3.5: crown-root integration.

#include "fusion/join.hpp"

#include <algorithm>

namespace rhizodont {
Joining join_crown_and_root(const TriangleMesh& crown, const std::vector<Point>& root_vertices,
                            const TriangleMesh& guiding_surface, const JoinOptions& options) {
  const DelaunayMesh delaunay = make_delaunay_mesh(crown, options.delaunay);
  Joining joining;
  joining.crown_vertices = static_cast<int>(crown.vertices.size());
  joining.steiner_points = static_cast<int>(delaunay.steiner_edges.size());
  joining.non_delaunay_edges_left = delaunay.edges_left;
  joining.sites = delaunay.mesh.vertices;
  joining.sites.insert(joining.sites.end(), root_vertices.begin(), root_vertices.end());

  RestrictedVoronoi voronoi = restricted_voronoi(joining.sites, guiding_surface, options.voronoi);
  joining.triangles = std::move(voronoi.triangles);
  joining.triangles.erase(std::unique(joining.triangles.begin(), joining.triangles.end()), joining.triangles.end());
  joining.sites_without_cell =
      static_cast<int>(std::count(voronoi.site_has_cell.begin(), voronoi.site_has_cell.end(), false));

  joining.crown_in_dual = triangles_given_by_dual(crown, delaunay, joining.triangles);
  joining.crown_triangles_direct =
      static_cast<int>(std::count(joining.crown_in_dual.begin(), joining.crown_in_dual.end(), true));
  return joining;
}

}  // namespace rhizodont
