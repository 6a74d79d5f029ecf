// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// P. Liepa, "Filling holes in meshes", Symposium on Geometry Processing 2003, as implemented in CGAL.

#include "fusion/fill_holes.hpp"

#include "fusion/clear_filling.hpp"
#include "mesh/at.hpp"
#include "mesh/diagnosis.hpp"
#include "mesh/self_intersection.hpp"
#include "mesh/surface_mesh.hpp"
#include "rhizodont/error.hpp"

#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <utility>
#include <vector>

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

/// A hole's border and the triangles that close it.
struct Filling {
  std::vector<std::int64_t> vertices;
  std::vector<Triangle> triangles;
};

/// By lowest vertex: the order in which holes are found follows the order of edges.
std::vector<Filling> fillings(const TriangleMesh& mesh) {
  assert(diagnose(mesh).is_oriented_manifold());
  SurfaceMesh surface = to_surface_mesh(mesh);
  std::vector<SurfaceMesh::Halfedge_index> borders;
  processing::extract_boundary_cycles(surface, std::back_inserter(borders));
  std::sort(borders.begin(), borders.end(), [&](auto x, auto y) {
    const auto a = hole_vertices(surface, x);
    const auto b = hole_vertices(surface, y);
    return *std::min_element(a.begin(), a.end()) < *std::min_element(b.begin(), b.end());
  });
  std::vector<Filling> holes;
  for (const auto border : borders) {
    Filling& hole = holes.emplace_back();
    hole.vertices = hole_vertices(surface, border);
    std::vector<SurfaceMesh::Face_index> faces;
    processing::triangulate_hole(surface, border, std::back_inserter(faces),
                                 CGAL::parameters::use_delaunay_triangulation(true).do_not_use_cubic_algorithm(
                                     hole.vertices.size() > most_vertices_of_full_search));
    if (faces.empty())
      throw NoResultError("A gap between the crown and its root could not be closed (ids of its vertices).",
                          hole.vertices, ElementKind::vertices);
    for (const auto face : faces) hole.triangles.push_back(to_triangle(surface, face));
  }
  return holes;
}

FilledMesh filled(const TriangleMesh& mesh, const std::vector<Filling>& holes) {
  FilledMesh result{mesh, static_cast<int>(holes.size())};
  for (const Filling& hole : holes)
    result.mesh.triangles.insert(result.mesh.triangles.end(), hole.triangles.begin(), hole.triangles.end());
  return result;
}

/// Which holes have triangles that meet others.
std::vector<bool> meeting_others(const TriangleMesh& mesh, const std::vector<Filling>& holes) {
  std::vector<std::size_t> hole_of;
  for (std::size_t h = 0; h < holes.size(); ++h) hole_of.insert(hole_of.end(), holes[h].triangles.size(), h);
  std::vector<bool> meeting(holes.size(), false);
  for (const auto& [a, b] : self_intersecting_triangles(filled(mesh, holes).mesh, mesh.triangles.size()))
    for (const int t : {a, b})
      if (at(t) >= mesh.triangles.size()) meeting[hole_of[at(t) - mesh.triangles.size()]] = true;
  return meeting;
}

}  // namespace

FilledMesh fill_holes(const TriangleMesh& mesh) { return filled(mesh, fillings(mesh)); }

FilledMesh fill_holes_clear(const TriangleMesh& mesh) {
  std::vector<Filling> holes = fillings(mesh);
  const std::vector<bool> meeting = meeting_others(mesh, holes);
  TriangleMesh around = mesh;
  for (std::size_t h = 0; h < holes.size(); ++h)
    if (!meeting[h])
      around.triangles.insert(around.triangles.end(), holes[h].triangles.begin(), holes[h].triangles.end());
  for (std::size_t h = 0; h < holes.size(); ++h) {
    if (!meeting[h]) continue;
    const std::vector<int> border(holes[h].vertices.begin(), holes[h].vertices.end());
    if (auto clear = clear_filling(around, border)) holes[h].triangles = std::move(*clear);
    around.triangles.insert(around.triangles.end(), holes[h].triangles.begin(), holes[h].triangles.end());
  }
  return filled(mesh, holes);
}

}  // namespace rhizodont
