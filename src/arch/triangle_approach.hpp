// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

#include <array>

namespace rhizodont {

using Corners = std::array<Point, 3>;  ///< of a triangle, mm

/// Where two triangles come nearest.
struct TriangleApproach {
  double squared_distance = 0;  ///< mm^2, of the two points
  Point on_first, on_second;    ///< the same point where the triangles meet
};

/// The nearest points of two triangles with area: a corner of one and a point of the other, or points of two edges.
/// Precondition: finite. Whether the triangles meet is decided exactly on the given doubles, and the distance is 0
/// then; else it is that of points of both triangles, right to rounding also beside nearly parallel edges.
TriangleApproach nearest_of_triangles(const Corners& first, const Corners& second);

/// True where the triangles have a point in common; exact. Precondition: finite, with area.
bool triangles_meet(const Corners& first, const Corners& second);

/// True where the corners lie on one line; exact.
bool has_no_area(const Corners& triangle);

/// The part of the way from p to q, 0..1, at which it goes through the triangle; less than 0 where it does not (exact),
/// or runs in the triangle's plane.
double crossing_of_edge(const Point& p, const Point& q, const Corners& triangle);

}  // namespace rhizodont
