// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/error.hpp"
#include "rhizodont/mesh.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>

namespace rhizodont {

using SurfaceMesh = CGAL::Surface_mesh<CGAL::Exact_predicates_inexact_constructions_kernel::Point_3>;

/// The mesh as CGAL sees it; vertices and faces keep their numbers. Throws NoResultError (id of the triangle) where the
/// mesh is not an oriented manifold.
inline SurfaceMesh to_surface_mesh(const TriangleMesh& mesh) {
  SurfaceMesh surface;
  surface.reserve(mesh.vertices.size(), 3 * mesh.triangles.size() / 2, mesh.triangles.size());
  for (const Point& p : mesh.vertices) surface.add_vertex({p.x(), p.y(), p.z()});
  using Vertex = SurfaceMesh::Vertex_index;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [a, b, c] = mesh.triangles[t];
    const auto face = surface.add_face(Vertex(static_cast<unsigned>(a)), Vertex(static_cast<unsigned>(b)),
                                       Vertex(static_cast<unsigned>(c)));
    if (face == SurfaceMesh::null_face())
      throw NoResultError("The surface is not a manifold at one of its triangles.", {static_cast<std::int64_t>(t)});
  }
  return surface;
}

/// The three vertices of a face.
inline Triangle to_triangle(const SurfaceMesh& surface, SurfaceMesh::Face_index face) {
  const auto h = surface.halfedge(face);
  return {static_cast<std::int32_t>(surface.source(h)), static_cast<std::int32_t>(surface.target(h)),
          static_cast<std::int32_t>(surface.target(surface.next(h)))};
}

inline Point to_point(const SurfaceMesh::Point& p) { return {p.x(), p.y(), p.z()}; }

/// Back from CGAL; elements that were removed are dropped, so that numbers run through.
inline TriangleMesh from_surface_mesh(SurfaceMesh& surface) {
  surface.collect_garbage();
  TriangleMesh mesh;
  for (const auto v : surface.vertices()) mesh.vertices.push_back(to_point(surface.point(v)));
  for (const auto f : surface.faces()) mesh.triangles.push_back(to_triangle(surface, f));
  return mesh;
}

}  // namespace rhizodont
