// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>
#include <span>

#include "poisson/field_sample.hpp"
#include "rhizodont/mesh.hpp"

namespace rhizodont {

/// A scalar field with its gradient, larger inside the solid. Must be safe to call from many threads at once.
using ScalarField = std::function<FieldSample(const Point&)>;

/// How `mid_normal` and `grad_normal` work. The defaults are the product's.
struct IsosurfaceOptions {
  double e = 0.5;                  ///< mm, > 0: side of the triangular lattice under the tiling; edges are about e / 2
  Point origin = Point::Zero();    ///< mm: a vertex of the lattice
  double tolerance = 1e-7;         ///< mm, > 0: distance of the projected vertices from the surface
  double max_displacement = 0.62;  ///< (0, 1], times e: farthest a vertex may be moved by the projection
  bool relax =
      true;  ///< after the projection, slide vertices of triangles beyond the promised angles along the surface
  bool as_ball = false;          ///< cut bridges or fill tunnels as thin as the tiling, until the surface is a sphere
  double max_change = 8.0;       ///< mm^2, >= 0: section of bridges and tunnels that may be closed for that
  bool every_component = false;  ///< keep all parts; for `marching_tetrahedra` only
  std::size_t max_cells = 20'000'000;  ///< cut tetrahedra before the surface is taken for unbounded
};

/// Throws UsageError for an option out of its range.
void require_in_range(const IsosurfaceOptions& options);

/// An isosurface and how it came about.
struct Isosurface {
  TriangleMesh mesh;                    ///< closed, 2-manifold, oriented outward, one component
  int euler_number = 0;                 ///< vertices - edges + triangles: 2 for a sphere, 0 for a torus
  std::size_t dropped_components = 0;   ///< bubbles and other parts that fewer seeds touch
  std::size_t visited_cells = 0;        ///< cut tetrahedra
  std::size_t evaluated_vertices = 0;   ///< lattice vertices at which the field was evaluated
  std::size_t relabelled_vertices = 0;  ///< lattice vertices that changed sides to cut bridges or fill tunnels
  std::size_t removed_vertices = 0;     ///< of valence 4, before the projection
  std::size_t relaxed_vertices = 0;     ///< slid along the surface after the projection
  std::size_t restrained_vertices = 0;  ///< kept nearer to their lattice edge than projected, so that no triangle flips
};

/// MidNormal (Hass and Trnkova 2020): the surface field = iso as a mesh whose vertices are midpoints of the edges of
/// the Goldberg tiling with a = sqrt(2) e / 4. Right topology, angles of 45 to 90 degrees, jagged.
///
/// Only tetrahedra that the surface cuts are visited, from the seeds on: the work grows with area / e^2.
///
/// \param field  larger inside
/// \param iso    the value on the surface; a lattice vertex with exactly this value counts as outside
/// \param seeds  points (mm) on or near the surface; of several components the one that most seeds touch is kept
/// \throws UsageError     an option out of its range
/// \throws InputError     no seeds, non-finite seeds (ids = seeds)
/// \throws NoResultError  no surface near any seed, or one without end; with `as_ball`, wide bridges or tunnels
Isosurface mid_normal(const ScalarField& field, double iso, std::span<const Point> seeds,
                      const IsosurfaceOptions& options = {});

/// GradNormal (paper, 3.4; Hass and Trnkova 2020): like `mid_normal`; then vertices of valence 4 are removed and all
/// others projected to the surface. Angles of 35.2 to 101.5 degrees where e is below about a fifth of the radius of
/// curvature. Parameters and errors as for `mid_normal`.
Isosurface grad_normal(const ScalarField& field, double iso, std::span<const Point> seeds,
                       const IsosurfaceOptions& options = {});

/// The plain isosurface: a vertex on each cut edge of the tiling, where the field passes the value to the tolerance,
/// and the triangles between them as they come. With `every_component` all parts that the seeds touch. Triangles may be
/// needles. Parameters and errors as for `mid_normal`; `as_ball` is not looked at.
TriangleMesh marching_tetrahedra(const ScalarField& field, double iso, std::span<const Point> seeds,
                                 const IsosurfaceOptions& options = {});

}  // namespace rhizodont
