// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

#include <cstdint>

namespace rhizodont {

/// A site of a Voronoi diagram as the predicates see it. The index decides ties: sites carry infinitesimal power
/// weights of decreasing order by index, so that no predicate ever returns zero and results depend neither on memory
/// addresses nor on threads.
struct Site {
  const Point* position;  ///< millimetres
  std::int32_t index;     ///< unique among the sites of one diagram
};

/// The predicates below return +1 if the point q is nearer to p0 than to the last site, -1 if it is farther.
/// They are exact: a floating-point filter first, exact rationals where the filter cannot decide, symbolic
/// perturbation of the sites where the exact value is zero. Only input points enter, never constructed ones.
/// Formulas: B. Levy and N. Bonneel, "Variational anisotropic surface meshing with Voronoi parallel linear
/// enumeration", 2013; perturbation: H. Edelsbrunner and E. Muecke, "Simulation of simplicity", 1990.

/// q = q0.
int side1(Site p0, Site p1, const Point& q0);

/// q = the bisector of p0 and p1 met with the segment (q0, q1). Precondition: that point exists.
int side2(Site p0, Site p1, Site p2, const Point& q0, const Point& q1);

/// q = the bisectors of (p0, p1) and (p0, p2) met with the triangle (q0, q1, q2). Precondition: that point exists.
int side3(Site p0, Site p1, Site p2, Site p3, const Point& q0, const Point& q1, const Point& q2);

/// Whether the edge from a to b is Delaunay between the triangles (a, b, c) and (b, a, d): +1 if the angles at c and d
/// sum to less than pi, -1 if to more, 0 if to pi. Exact: the sign of cot(c) + cot(d), by comparing squares. Angles of
/// triangles without area are 0 or pi, or 0 where c or d is an end of the edge.
int delaunay_sign(const Point& a, const Point& b, const Point& c, const Point& d);

}  // namespace rhizodont
