// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Remeshing: M. Botsch, L. Kobbelt, "A remeshing approach to multiresolution modeling", 2004 (CGAL).
#include "atlas/scanner_mesh.hpp"

#include "atlas/random_stream.hpp"
#include "atlas/remeshing.hpp"
#include "mesh/adjacency.hpp"
#include "mesh/diagnosis.hpp"
#include "mesh/float_bits.hpp"
#include "mesh/geometry.hpp"
#include "mesh/self_intersection.hpp"
#include "rhizodont/error.hpp"

#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/remesh.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>

#include <array>

namespace rhizodont {
namespace {

using Surface = CGAL::Surface_mesh<CGAL::Simple_cartesian<double>::Point_3>;

Surface to_surface(const TriangleMesh& mesh) {
  Surface surface;
  for (const Point& p : mesh.vertices) surface.add_vertex({p.x(), p.y(), p.z()});
  const auto vertex = [](int v) { return Surface::Vertex_index(static_cast<std::uint32_t>(v)); };
  for (const Triangle& t : mesh.triangles) surface.add_face(vertex(t[0]), vertex(t[1]), vertex(t[2]));
  return surface;
}

TriangleMesh from_surface(const Surface& surface) {
  TriangleMesh mesh;
  for (const auto v : surface.vertices())
    mesh.vertices.emplace_back(surface.point(v).x(), surface.point(v).y(), surface.point(v).z());
  for (const auto f : surface.faces()) {
    Triangle t{};
    std::size_t i = 0;
    for (const auto v : surface.vertices_around_face(surface.halfedge(f)))
      t[i++] = static_cast<std::int32_t>(static_cast<std::uint32_t>(v));
    mesh.triangles.push_back(t);
  }
  return mesh;
}

}  // namespace

TriangleMesh remeshed(const TriangleMesh& mesh, double edge_mm) {
  namespace PMP = CGAL::Polygon_mesh_processing;
  Surface surface = to_surface(mesh);
  PMP::isotropic_remeshing(surface.faces(), edge_mm, surface,
                           PMP::parameters::number_of_iterations(2).number_of_relaxation_steps(1));
  surface.collect_garbage();
  return from_surface(surface);
}

TriangleMesh scanner_mesh(const TriangleMesh& crown, double edge_mm, double noise_mm, std::uint64_t seed) {
  if (!(edge_mm >= 0.1 && edge_mm <= 1)) throw UsageError("The edge length of a scan lies between 0.1 and 1 mm.");
  if (!(noise_mm >= 0 && noise_mm <= 0.1)) throw UsageError("The noise of a scan lies between 0 and 0.1 mm.");
  TriangleMesh mesh = remeshed(crown, edge_mm);
  const auto normals = vertex_normals(mesh);
  RandomStream random(seed, 300);
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    mesh.vertices[v] = nearest_float(Point(mesh.vertices[v] + random.normal(0.0, noise_mm) * normals[v]));
  const Diagnosis diagnosis = diagnose(mesh);
  if (!diagnosis.is_oriented_manifold() || diagnosis.border_loop_count != 1 || diagnosis.euler_number != 1 ||
      !self_intersecting_triangles(mesh).empty())
    throw NoResultError("The crown did not survive remeshing as a disc; another seed or edge length may do.");
  return mesh;
}

}  // namespace rhizodont
