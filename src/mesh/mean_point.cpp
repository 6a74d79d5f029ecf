// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/mean_point.hpp"

#include <cassert>

namespace rhizodont {

Point mean_point(const std::vector<Point>& points) {
  assert(!points.empty());
  Point sum = Point::Zero();
  for (const Point& p : points) sum += p;
  return sum / static_cast<double>(points.size());
}

}  // namespace rhizodont
