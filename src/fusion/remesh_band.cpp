// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// M. Botsch and L. Kobbelt, "A remeshing approach to multiresolution modeling", Symposium on Geometry Processing 2004,
// as
//   implemented in CGAL.

#include "fusion/remesh_band.hpp"

#include "fusion/surface_mesh.hpp"
#include "mesh/nearest_vertex.hpp"

#include <CGAL/Polygon_mesh_processing/remesh.h>

#include <cmath>
#include <vector>

namespace rhizodont {
namespace {

namespace processing = CGAL::Polygon_mesh_processing;

/// What the band looks like before it is remeshed.
struct Band {
  std::vector<SurfaceMesh::Face_index> faces;
  double border_edge = 0;  // mean length in mm of the crown's border edges
  double root_edge = 0;    // mean length in mm of the edges of new triangles outside the band
};

double edge_length(const SurfaceMesh& mesh, SurfaceMesh::Halfedge_index h) {
  return std::sqrt(CGAL::squared_distance(mesh.point(mesh.source(h)), mesh.point(mesh.target(h))));
}

Band find_band(const SurfaceMesh& mesh, std::size_t crown_triangles, double width) {
  const auto is_crown = [&](SurfaceMesh::Face_index f) { return static_cast<std::size_t>(f) < crown_triangles; };
  Band band;
  std::vector<Point> border;
  double border_sum = 0;
  for (const auto h : mesh.halfedges()) {
    if (!is_crown(mesh.face(h)) || is_crown(mesh.face(mesh.opposite(h)))) continue;
    border.push_back(to_point(mesh.point(mesh.target(h))));
    border_sum += edge_length(mesh, h);
  }
  band.border_edge = border_sum / static_cast<double>(border.size());
  const NearestVertexIndex index(border);
  double root_sum = 0;
  std::size_t root_count = 0;
  for (const auto f : mesh.faces()) {
    if (is_crown(f)) continue;
    bool near = false;
    for (const auto h : mesh.halfedges_around_face(mesh.halfedge(f)))
      near |= index.nearest(to_point(mesh.point(mesh.target(h)))).squared_distance <= width * width;
    if (near) {
      band.faces.push_back(f);
      continue;
    }
    for (const auto h : mesh.halfedges_around_face(mesh.halfedge(f))) root_sum += edge_length(mesh, h);
    root_count += 3;
  }
  band.root_edge = root_count > 0 ? root_sum / static_cast<double>(root_count) : band.border_edge;
  return band;
}

}  // namespace

void remesh_band(RestoredTooth& tooth, const RemeshBandOptions& options) {
  if (options.iterations <= 0 || !(options.band > 0)) return;
  SurfaceMesh mesh = to_surface_mesh(tooth.mesh);
  const auto crown_triangles = static_cast<std::size_t>(tooth.crown_triangles);
  const Band band = find_band(mesh, crown_triangles, options.band);
  if (band.faces.empty()) return;
  auto [fixed_edge, created] = mesh.add_property_map<SurfaceMesh::Edge_index, bool>("e:fixed", false);
  std::vector<bool> in_band(tooth.mesh.triangles.size(), false);
  for (const auto f : band.faces) in_band[static_cast<std::size_t>(f)] = true;
  for (const auto e : mesh.edges()) {
    const auto h = mesh.halfedge(e);
    fixed_edge[e] = in_band[static_cast<std::size_t>(mesh.face(h))] !=
                    in_band[static_cast<std::size_t>(mesh.face(mesh.opposite(h)))];
  }
  processing::isotropic_remeshing(band.faces, std::sqrt(band.border_edge * band.root_edge), mesh,
                                  CGAL::parameters::number_of_iterations(static_cast<unsigned>(options.iterations))
                                      .edge_is_constrained_map(fixed_edge)
                                      .protect_constraints(true)
                                      .number_of_relaxation_steps(3));
  // The crown's elements were never removed, so they keep their numbers; the others are numbered anew behind them.
  TriangleMesh result;
  std::vector<int> number(mesh.number_of_vertices() + mesh.number_of_removed_vertices(), -1);
  for (const auto v : mesh.vertices()) {
    number[static_cast<std::size_t>(v)] = static_cast<int>(result.vertices.size());
    result.vertices.push_back(to_point(mesh.point(v)));
  }
  for (const auto f : mesh.faces()) {
    Triangle t = static_cast<std::size_t>(f) < crown_triangles ? tooth.mesh.triangles[static_cast<std::size_t>(f)]
                                                               : to_triangle(mesh, f);
    for (std::int32_t& v : t) v = number[static_cast<std::size_t>(v)];
    result.triangles.push_back(t);
  }
  tooth.mesh = std::move(result);
}

}  // namespace rhizodont
