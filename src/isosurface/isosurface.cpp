// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// MidNormal and GradNormal (Hass and Trnkova, Approximating isosurfaces by guaranteed-quality triangular meshes, 2020).
#include "isosurface/isosurface.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <cmath>

#include "base/option_range.hpp"
#include "isosurface/ball_labels.hpp"
#include "isosurface/cut_cells.hpp"
#include "isosurface/edge_mesh.hpp"
#include "isosurface/projection.hpp"
#include "isosurface/relaxation.hpp"
#include "mesh/geometry.hpp"
#include "rhizodont/error.hpp"

namespace rhizodont {
namespace {

void check_options(const IsosurfaceOptions& options, double iso) {
  if (!std::isfinite(iso)) throw UsageError("The value on the surface must be a number.");
  require_in_range(options);
}

/// Of a sheet as thick as the tiling one vertex takes up about e^2.
void check_extent(std::size_t changed_vertices, const IsosurfaceOptions& options) {
  if (static_cast<double>(changed_vertices) * options.e * options.e > options.max_change)
    throw NoResultError("The surface has a hole through it that is too wide to be closed: it is not that of a ball.");
}

struct Extraction {
  EdgeMesh edge_mesh;
  std::vector<EdgeVertex> vertices;
  Isosurface surface;
};

Extraction extract(const ScalarField& field, double iso, std::span<const Point> seeds, const IsosurfaceOptions& options,
                   bool even_valences) {
  check_options(options, iso);
  const GoldbergTiling tiling(options.e, options.origin);
  CutCells cells = find_cut_cells(field, iso, seeds, tiling, options);
  Extraction extraction;
  extraction.edge_mesh = triangulate_cells(cells);
  if (options.as_ball && checked_euler_number(extraction.edge_mesh.edges.size(), extraction.edge_mesh.triangles) != 2) {
    const LabelChanges changes = changes_to_ball(field, iso, cells, tiling, options.e);
    check_extent(changes.count, options);
    cells = find_cut_cells(field, iso, seeds, tiling, options, changes.inside);
    extraction.edge_mesh = triangulate_cells(cells);
    extraction.surface.relabelled_vertices = changes.count;
  }
  extraction.surface.dropped_components = cells.other_components;
  extraction.surface.visited_cells = cells.visited;
  extraction.surface.evaluated_vertices = cells.vertices.size();
  if (even_valences) extraction.surface.removed_vertices = remove_valence_4(extraction.edge_mesh);
  for (const auto& [inside, outside] : extraction.edge_mesh.edges) {
    EdgeVertex vertex;
    vertex.inside = tiling.position(cells.vertices[static_cast<std::size_t>(inside)]);
    vertex.outside = tiling.position(cells.vertices[static_cast<std::size_t>(outside)]);
    extraction.vertices.push_back(vertex);
  }
  extraction.surface.mesh.triangles = extraction.edge_mesh.triangles;
  extraction.surface.euler_number = checked_euler_number(extraction.vertices.size(), extraction.surface.mesh.triangles);
  return extraction;
}

void check_outward(const TriangleMesh& mesh) {
  if (!(volume(mesh) > 0.0))
    throw NoResultError(
        "The surface found encloses a hollow, not a solid: the field is larger outside it than inside.");
}

}  // namespace

void require_in_range(const IsosurfaceOptions& options) {
  if (!options.origin.allFinite()) throw UsageError("The option origin of the isosurface must be a point.");
  require_ranges("the isosurface", {{"e", options.e, OptionRange::above(0)},
                                    {"tolerance", options.tolerance, OptionRange::above(0)},
                                    {"max_displacement", options.max_displacement, OptionRange::above(0).at_most(1)},
                                    {"max_change", options.max_change, OptionRange::at_least(0)},
                                    {"max_cells", options.max_cells, OptionRange::at_least(1)}});
}

Isosurface mid_normal(const ScalarField& field, double iso, std::span<const Point> seeds,
                      const IsosurfaceOptions& options) {
  Extraction extraction = extract(field, iso, seeds, options, false);
  for (const EdgeVertex& vertex : extraction.vertices)
    extraction.surface.mesh.vertices.push_back(0.5 * (vertex.inside + vertex.outside));
  check_outward(extraction.surface.mesh);
  return std::move(extraction.surface);
}

Isosurface grad_normal(const ScalarField& field, double iso, std::span<const Point> seeds,
                       const IsosurfaceOptions& options) {
  Extraction extraction = extract(field, iso, seeds, options, true);
  project_vertices(field, iso, options, extraction.vertices);
  extraction.surface.restrained_vertices =
      restrain_flipped(extraction.vertices, extraction.surface.mesh.triangles, field);
  if (options.relax)
    extraction.surface.relaxed_vertices =
        relax_poor_triangles(field, iso, options, extraction.vertices, extraction.surface.mesh.triangles);
  for (const EdgeVertex& vertex : extraction.vertices) extraction.surface.mesh.vertices.push_back(vertex.position);
  check_outward(extraction.surface.mesh);
  return std::move(extraction.surface);
}

TriangleMesh marching_tetrahedra(const ScalarField& field, double iso, std::span<const Point> seeds,
                                 const IsosurfaceOptions& options) {
  check_options(options, iso);
  const GoldbergTiling tiling(options.e, options.origin);
  const CutCells cells = find_cut_cells(field, iso, seeds, tiling, options);
  EdgeMesh edge_mesh = triangulate_cells(cells);
  TriangleMesh mesh;
  mesh.triangles = std::move(edge_mesh.triangles);
  mesh.vertices.resize(edge_mesh.edges.size());
  tbb::parallel_for(std::size_t{0}, mesh.vertices.size(), [&](std::size_t v) {
    const auto& [in, out] = edge_mesh.edges[v];
    const Point inside = tiling.position(cells.vertices[static_cast<std::size_t>(in)]);
    const Point outside = tiling.position(cells.vertices[static_cast<std::size_t>(out)]);
    // The field is a smeared step, far from linear over an edge: interpolation would be off by more than the field is.
    mesh.vertices[v] = crossing_of_edge(field, iso, inside, outside, options.tolerance).value_or(outside);
  });
  return mesh;
}

}  // namespace rhizodont
