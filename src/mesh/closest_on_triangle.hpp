// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

namespace rhizodont {

/// Closest point of a triangle and where it lies: inside, on the edge from `feature` on, or at corner `feature`.
struct OnTriangle {
  enum class Where { inside, edge, corner };
  Point point;
  double squared_distance = 0;  ///< mm^2, from differences: exact also where the point's own digits end
  Where where = Where::inside;
  int feature = 0;
};

/// The point of triangle abc that is closest to p (C. Ericson, "Real-Time Collision Detection", 2005, 5.1.5).
OnTriangle closest_on_triangle(const Point& p, const Point& a, const Point& b, const Point& c);

}  // namespace rhizodont
