// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "mesh/closest_point.hpp"

#include <algorithm>
#include <vector>

namespace rhizodont {

/// Of points from a surface, mm.
struct Distances {
  double mean = 0, most = 0;
};

inline Distances distances(const std::vector<Point>& points, const ClosestPointIndex& surface) {
  Distances result;
  for (const Point& p : points) {
    const double d = surface.closest(p).distance;
    result.mean += d / static_cast<double>(points.size());
    result.most = std::max(result.most, d);
  }
  return result;
}

}  // namespace rhizodont
