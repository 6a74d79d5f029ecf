// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// "Completing Dental Models While Preserving Crown Geometry and Meshing Topology", section 3.5: crown-root integration.

#include "fusion/join.hpp"

#include "base/option_range.hpp"
#include "mesh/geometry.hpp"
#include "mesh/nearest_vertex.hpp"

#include <algorithm>

namespace rhizodont {
namespace {

/// The sites that are not crowded by an earlier one, ascending.
std::vector<int> uncrowded_sites(const std::vector<Point>& sites, double least_distance) {
  const NearestVertexIndex index(sites);
  std::vector<bool> crowded(sites.size(), false);
  std::vector<int> kept;
  for (std::size_t i = 0; i < sites.size(); ++i) {
    if (crowded[i]) continue;
    kept.push_back(static_cast<int>(i));
    for (const NearVertex& near : index.within(sites[i], least_distance))
      if (near.index > static_cast<int>(i)) crowded[static_cast<std::size_t>(near.index)] = true;
  }
  return kept;
}

}  // namespace

void require_in_range(const JoinOptions& options) {
  require_in_range(options.delaunay);
  require_in_range(options.voronoi);
  require_ranges("joining", {{"least_distance", options.least_distance, OptionRange::at_least(0)}});
}

Joining join_crown_and_root(const TriangleMesh& crown, const std::vector<Point>& root_vertices,
                            const TriangleMesh& guiding_surface, const JoinOptions& options) {
  return join_crown_and_root(crown, make_delaunay_mesh(crown, options.delaunay), root_vertices, guiding_surface,
                             options);
}

Joining join_crown_and_root(const TriangleMesh& crown, const DelaunayMesh& delaunay,
                            const std::vector<Point>& root_vertices, const TriangleMesh& guiding_surface,
                            const JoinOptions& options) {
  require_in_range(options);
  Joining joining;
  joining.crown_vertices = static_cast<int>(crown.vertices.size());
  joining.steiner_points = static_cast<int>(delaunay.steiner_edges.size());
  joining.non_delaunay_edges_left = delaunay.edges_left;
  joining.sites = delaunay.mesh.vertices;
  joining.sites.insert(joining.sites.end(), root_vertices.begin(), root_vertices.end());

  const std::vector<int> used = uncrowded_sites(joining.sites, options.least_distance * mean_edge_length(crown));
  joining.in_diagram.assign(joining.sites.size(), false);
  std::vector<Point> positions;
  for (const int i : used) {
    joining.in_diagram[static_cast<std::size_t>(i)] = true;
    positions.push_back(joining.sites[static_cast<std::size_t>(i)]);
  }
  RestrictedVoronoi voronoi = restricted_voronoi(positions, guiding_surface, options.voronoi);
  joining.triangles = std::move(voronoi.triangles);
  for (Triangle& t : joining.triangles)
    for (std::int32_t& v : t) v = used[static_cast<std::size_t>(v)];  // ascending, so that the order stays
  joining.triangles.erase(std::unique(joining.triangles.begin(), joining.triangles.end()), joining.triangles.end());
  joining.sites_without_cell =
      static_cast<int>(std::count(voronoi.site_has_cell.begin(), voronoi.site_has_cell.end(), false)) +
      static_cast<int>(joining.sites.size() - used.size());

  joining.crown_in_dual = triangles_given_by_dual(crown, delaunay, joining.triangles);
  joining.crown_triangles_direct =
      static_cast<int>(std::count(joining.crown_in_dual.begin(), joining.crown_in_dual.end(), true));
  return joining;
}

}  // namespace rhizodont
