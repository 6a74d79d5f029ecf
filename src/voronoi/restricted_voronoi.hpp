// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

#include <vector>

namespace rhizodont {

struct RestrictedVoronoiOptions {
  int neighbours = 16;        ///< nearest sites listed per site at first, >= 1; the lists grow where a cell needs more
  bool cell_moments = false;  ///< also compute areas, masses and centroids of the cells
  std::vector<double>
      density;  ///< for masses and centroids: per vertex of the surface, >= 0, linear in between; empty: 1
};

/// Throws UsageError for an option out of its range.
void require_in_range(const RestrictedVoronoiOptions& options);

/// The Voronoi diagram of sites restricted to a surface, seen through its dual.
struct RestrictedVoronoi {
  /// The dual (restricted Delaunay triangles): one per point of the surface where three cells meet, counterclockwise
  /// from outside, lowest site first; sorted by site indices. A triangle stands twice if three cells meet twice.
  std::vector<Triangle> triangles;
  std::vector<bool> site_has_cell;   ///< per site: false if no part of the surface is nearest to it
  std::vector<double> cell_area;     ///< mm^2 per site; empty unless asked for
  std::vector<double> cell_mass;     ///< integral of the density per site; empty unless asked for
  std::vector<Point> cell_centroid;  ///< per site, weighted by the density, not on the surface in general; the site
                                     ///< itself where there is no mass; empty unless asked for
};

/// The same triangle written with its lowest index first, as in `RestrictedVoronoi::triangles`.
Triangle lowest_first(Triangle triangle);

/// Computes the restricted Voronoi diagram of `sites` on `surface` and its dual.
///
/// Every decision is made by exact predicates with symbolic perturbation, so the polygons of neighbouring facets agree
/// whatever the positions (co-spherical sites, coinciding sites, sites at vertices of the surface). Facets are worked
/// on in parallel; the result does not depend on the number of threads. The dual is a closed manifold where each cell
/// is a disc (closed-ball property, Edelsbrunner and Shah 1997); nothing else is promised.
///
/// Throws InputError for no sites, no triangles, or non-finite coordinates (ids of the sites); UsageError for options
/// out of their ranges.
/// Source: D.-M. Yan et al., "Isotropic remeshing with fast and exact computation of restricted Voronoi diagram", 2009;
/// security radius: B. Levy and N. Bonneel 2013.
RestrictedVoronoi restricted_voronoi(const std::vector<Point>& sites, const TriangleMesh& surface,
                                     const RestrictedVoronoiOptions& options = {});

}  // namespace rhizodont
