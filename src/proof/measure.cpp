// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "rhizodont/measure.hpp"

#include "mesh/adjacency.hpp"
#include "mesh/diagnosis.hpp"
#include "mesh/geometry.hpp"
#include "mesh/quality.hpp"
#include "mesh/self_intersection.hpp"
#include "rhizodont/error.hpp"

#include <algorithm>
#include <limits>

namespace rhizodont {
namespace {

template <class Ids>
std::int64_t count(const Ids& ids) {
  return static_cast<std::int64_t>(ids.size());
}

void refuse_unusable(const TriangleMesh& mesh, const Diagnosis& found) {
  if (mesh.triangles.empty()) throw InputError("the mesh has no triangles");
  if (found.is_valid()) return;
  std::string sentence;
  for (const std::string& defect : describe_defects(found)) sentence += (sentence.empty() ? "" : "; ") + defect;
  throw InputError("the mesh cannot be measured: " + sentence);
}

void measure_topology(const TriangleMesh& mesh, const Diagnosis& found, MeshMeasures& measures) {
  measures.vertices = found.vertices;
  measures.edges = found.edges;
  measures.triangles = found.triangles;
  measures.unreferenced_vertices = count(found.unreferenced_vertices);
  measures.duplicate_vertices = count(found.duplicate_vertices);
  measures.duplicate_triangles = count(found.duplicate_triangles);
  measures.degenerate_triangles = count(found.degenerate_triangles);
  measures.border_edges = count(found.border_edges);
  measures.non_manifold_edges = count(found.non_manifold_edges);
  measures.misoriented_edges = count(found.misoriented_edges);
  measures.non_manifold_vertices = count(found.non_manifold_vertices);
  measures.self_intersections = count(self_intersecting_triangles(mesh));
  measures.components = found.components;
  measures.border_loops = found.border_loop_count;
  measures.euler_number = found.euler_number;
  measures.genus = found.genus;
  measures.defects = describe_defects(found);
}

void measure_edges(const TriangleMesh& mesh, MeshMeasures& measures) {
  measures.edge_min = std::numeric_limits<double>::infinity();
  double sum = 0;
  const EdgeTable table = edge_table(mesh);
  for (const auto& [a, b] : table.vertices) {
    const double length =
        (mesh.vertices[static_cast<std::size_t>(a)] - mesh.vertices[static_cast<std::size_t>(b)]).norm();
    sum += length;
    measures.edge_min = std::min(measures.edge_min, length);
    measures.edge_max = std::max(measures.edge_max, length);
  }
  measures.edge_mean = sum / static_cast<double>(table.size());
}

void measure_size(const TriangleMesh& mesh, MeshMeasures& measures) {
  const Eigen::AlignedBox3d box = bounding_box(compact(mesh).mesh.vertices);
  Eigen::Map<Point>(measures.lowest.data()) = box.min();
  Eigen::Map<Point>(measures.highest.data()) = box.max();
  measures.diagonal = box.diagonal().norm();
  measures.area = surface_area(mesh);
}

}  // namespace

MeshMeasures measure(const TriangleMesh& mesh) {
  const Diagnosis found = diagnose(mesh);
  refuse_unusable(mesh, found);
  MeshMeasures measures;
  measures.quality = quality(mesh).value();
  measure_topology(mesh, found, measures);
  measure_edges(mesh, measures);
  measure_size(mesh, measures);
  measures.closed = found.is_closed_manifold();
  if (measures.closed) measures.volume = found.volume;
  return measures;
}

}  // namespace rhizodont
