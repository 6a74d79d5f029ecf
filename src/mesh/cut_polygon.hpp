// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace rhizodont {

/// How a polygon was cut into triangles.
enum class PolygonCut {
  fan,             ///< from its first corner: right for convex polygons and all that this corner sees whole
  constrained,     ///< by a constrained Delaunay triangulation of its inside: concave polygons
  fan_as_it_cuts,  ///< from its first corner although that is wrong, for its outline cuts or touches itself
};

struct CutPolygon {
  std::vector<Triangle> triangles;  ///< two fewer than corners, turned as the polygon is
  PolygonCut cut = PolygonCut::fan;
};

/// Cuts a polygon of three or more corners, plane or slightly bent, into triangles, as seen along the axis that its
/// area vector is nearest to; predicates are exact on the coordinates given. Outlines that reach a hole over an edge
/// walked both ways are cut rightly too. Precondition: corners are vertices, with finite coordinates.
CutPolygon cut_polygon(const std::vector<Point>& vertices, std::span<const std::int32_t> corners);

}  // namespace rhizodont
