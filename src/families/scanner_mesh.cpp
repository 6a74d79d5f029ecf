// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Remeshing: M. Botsch, L. Kobbelt, "A remeshing approach to multiresolution modeling", 2004 (CGAL).
#include "families/scanner_mesh.hpp"

#include "base/float_bits.hpp"
#include "base/random_stream.hpp"
#include "families/remeshing.hpp"
#include "mesh/adjacency.hpp"
#include "mesh/diagnosis.hpp"
#include "mesh/geometry.hpp"
#include "mesh/self_intersection.hpp"
#include "mesh/surface_mesh.hpp"
#include "rhizodont/error.hpp"

#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/remesh.h>

#include <array>

namespace rhizodont {

TriangleMesh remeshed(const TriangleMesh& mesh, double edge_mm) {
  namespace PMP = CGAL::Polygon_mesh_processing;
  SurfaceMesh surface = to_surface_mesh(mesh);
  PMP::isotropic_remeshing(surface.faces(), edge_mm, surface,
                           PMP::parameters::number_of_iterations(2).number_of_relaxation_steps(1));
  return from_surface_mesh(surface);
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
