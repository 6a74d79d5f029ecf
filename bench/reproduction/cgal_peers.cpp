// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "reproduction/cgal_peers.hpp"

#include "evaluation/root_figures.hpp"
#include "mesh/surface_mesh.hpp"
#include "rhizodont/error.hpp"
#include "teeth/crown_border.hpp"

#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/clip.h>
#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Polygon_mesh_processing/remesh.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>

#include <iterator>
#include <tuple>
#include <vector>

namespace rhizodont {
namespace {

namespace processing = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

std::vector<SurfaceMesh::Halfedge_index> borders(const SurfaceMesh& mesh) {
  std::vector<SurfaceMesh::Halfedge_index> one_each;
  processing::extract_boundary_cycles(mesh, std::back_inserter(one_each));
  return one_each;
}

SurfaceMesh closed_flat(const TriangleMesh& crown) {
  SurfaceMesh mesh = to_surface_mesh(crown);
  for (const auto border : borders(mesh)) {
    std::vector<SurfaceMesh::Face_index> faces;
    processing::triangulate_hole(mesh, border, std::back_inserter(faces));
    if (faces.empty()) throw NoResultError("CGAL cannot close the crown.");
  }
  return mesh;
}

Point middle_of_border(const TriangleMesh& crown) {
  const CrownBorder border = find_crown_border(crown);
  Point sum = Point::Zero();
  for (const auto& edge : border.half_edges) sum += crown.vertices[static_cast<std::size_t>(edge.first)];
  return sum / static_cast<double>(border.half_edges.size());
}

}  // namespace

TriangleMesh cgal_filled(const TriangleMesh& crown) {
  SurfaceMesh mesh = to_surface_mesh(crown);
  for (const auto border : borders(mesh)) {
    std::vector<SurfaceMesh::Face_index> faces;
    std::vector<SurfaceMesh::Vertex_index> vertices;
    const bool faired = std::get<0>(processing::triangulate_refine_and_fair_hole(
        mesh, border, std::back_inserter(faces), std::back_inserter(vertices)));
    if (!faired || faces.empty()) throw NoResultError("CGAL cannot close the crown.");
  }
  return from_surface_mesh(mesh);
}

TriangleMesh cgal_united(const TriangleMesh& crown, const TriangleMesh& fitted_tooth, double overlap_mm) {
  SurfaceMesh upper = closed_flat(crown);
  SurfaceMesh lower = to_surface_mesh(fitted_tooth);
  const Eigen::Vector3d axis = crown_growth_axis(crown);
  const Point on_plane = middle_of_border(crown) + overlap_mm * axis;
  const Kernel::Plane_3 plane(Kernel::Point_3(on_plane.x(), on_plane.y(), on_plane.z()),
                              Kernel::Vector_3(axis.x(), axis.y(), axis.z()));
  if (!processing::clip(lower, plane, CGAL::parameters::clip_volume(true)))
    throw NoResultError("CGAL cannot cut the fitted tooth in two.");
  SurfaceMesh united;
  const auto checked = CGAL::parameters::throw_on_self_intersection(true);
  if (!processing::corefine_and_compute_union(upper, lower, united, checked))
    throw NoResultError("The union of crown and root is no manifold.");
  return from_surface_mesh(united);
}

TriangleMesh cgal_remeshed(const TriangleMesh& mesh, double edge_mm, unsigned rounds) {
  SurfaceMesh surface = to_surface_mesh(mesh);
  processing::isotropic_remeshing(faces(surface), edge_mm, surface, CGAL::parameters::number_of_iterations(rounds));
  return from_surface_mesh(surface);
}

}  // namespace rhizodont
