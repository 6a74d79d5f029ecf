// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// P. Liepa, "Filling holes in meshes", Symposium on Geometry Processing 2003, as implemented in CGAL.

#include "fusion/fill_holes.hpp"
#include "mesh/diagnosis.hpp"

#include "mesh/surface_mesh.hpp"
#include "rhizodont/error.hpp"

#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>

#include <algorithm>
#include <cassert>
#include <iterator>

namespace rhizodont {
namespace {

namespace processing = CGAL::Polygon_mesh_processing;

/// Triangles are looked for among the edges of a Delaunay triangulation of the hole's border. Where those close no
/// hole, all that its border vertices span are tried, at a cost of the third power of their number: up to so many
/// vertices.
constexpr std::size_t most_vertices_of_full_search = 400;

std::vector<std::int64_t> hole_vertices(const SurfaceMesh& mesh, SurfaceMesh::Halfedge_index border) {
  std::vector<std::int64_t> ids;
  for (const auto h : CGAL::halfedges_around_face(border, mesh)) ids.push_back(static_cast<int>(mesh.target(h)));
  return ids;
}

}  // namespace

FilledMesh fill_holes(const TriangleMesh& mesh) {
  assert(diagnose(mesh).is_oriented_manifold());
  SurfaceMesh surface = to_surface_mesh(mesh);
  std::vector<SurfaceMesh::Halfedge_index> borders;
  processing::extract_boundary_cycles(surface, std::back_inserter(borders));
  // By lowest vertex: the order in which holes are found follows the order of edges.
  std::sort(borders.begin(), borders.end(), [&](auto x, auto y) {
    const auto a = hole_vertices(surface, x);
    const auto b = hole_vertices(surface, y);
    return *std::min_element(a.begin(), a.end()) < *std::min_element(b.begin(), b.end());
  });
  FilledMesh result{mesh, static_cast<int>(borders.size())};
  for (const auto border : borders) {
    const auto ids = hole_vertices(surface, border);
    std::vector<SurfaceMesh::Face_index> faces;
    processing::triangulate_hole(surface, border, std::back_inserter(faces),
                                 CGAL::parameters::use_delaunay_triangulation(true).do_not_use_cubic_algorithm(
                                     ids.size() > most_vertices_of_full_search));
    if (faces.empty())
      throw NoResultError("A gap between the crown and its root could not be closed (ids of its vertices).", ids,
                          ElementKind::vertices);
    for (const auto face : faces) result.mesh.triangles.push_back(to_triangle(surface, face));
  }
  return result;
}

}  // namespace rhizodont
