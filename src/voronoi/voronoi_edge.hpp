// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

#include <vector>

namespace rhizodont {

/// The points of space that are nearest to three sites alike: what is dual to their triangle in the Voronoi diagram of
/// all sites. It is the part from `low` to `high` of the triangle's axis, `centre` + t `direction`.
struct VoronoiEdge {
  Point centre;               ///< of the triangle's circumcircle
  Eigen::Vector3d direction;  ///< unit normal of the triangle, counterclockwise
  double low = 0;             ///< mm, -infinity if the edge has no end
  double high = 0;            ///< mm, +infinity if the edge has no end
  int low_site = -1;          ///< site that ends the edge at `low`, -1 for none
  int high_site = -1;         ///< likewise at `high`
  bool is_empty() const { return !(low <= high); }
};

/// Every site s off the triangle (a, b, c) allows one side of a point of the axis: with d = s - a, h = d . direction
/// and kappa = |d|^2 - 2 d . (centre - a), those with 2 t h <= kappa. Rounded, in contrast to `restricted_voronoi`:
/// meant for explaining what the dual lacks, and for testing. O(sites).
/// Precondition: indices in range. Throws InputError for a triangle without area.
VoronoiEdge voronoi_edge(const std::vector<Point>& sites, const Triangle& triangle);

/// Where a surface crosses a triangle's axis from inside to outside, as the triangle faces: t of each crossing,
/// ascending. The triangle is in the dual of the diagram restricted to the surface, as it faces, if and only if one of
/// them is in [low, high]. O(facets).
std::vector<double> outward_crossings(const TriangleMesh& surface, const VoronoiEdge& edge);

}  // namespace rhizodont
