// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "arch/triangle_approach.hpp"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/squared_distance_3.h>

#include <cmath>

namespace rhizodont::test {

/// The distance of two triangles by exact rationals, rounded once at the end.
inline double exact_distance(const Corners& a, const Corners& b) {
  using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
  const auto triangle = [](const Corners& t) {
    const auto point = [](const Point& p) { return Kernel::Point_3(p.x(), p.y(), p.z()); };
    return Kernel::Triangle_3(point(t[0]), point(t[1]), point(t[2]));
  };
  return std::sqrt(CGAL::to_double(CGAL::exact(CGAL::squared_distance(triangle(a), triangle(b)))));
}

}  // namespace rhizodont::test
