// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "arch/neck.hpp"

#include "mesh/geometry.hpp"

#include <algorithm>
#include <limits>

namespace rhizodont {

Point middle_of_border(const CompletedTooth& tooth) {
  const auto is_scan = [&](int v) { return tooth.source[static_cast<std::size_t>(v)] == VertexSource::scan; };
  const auto at = [&](int v) -> const Point& { return tooth.mesh.vertices[static_cast<std::size_t>(v)]; };
  Point sum = Point::Zero();
  double length = 0;
  for (const Triangle& t : tooth.mesh.triangles) {
    if (std::all_of(t.begin(), t.end(), is_scan)) continue;
    for (std::size_t i = 0; i < 3; ++i) {
      const int a = t[i], b = t[(i + 1) % 3];
      if (!is_scan(a) || !is_scan(b)) continue;
      sum += 0.5 * (at(a) - at(b)).norm() * (at(a) + at(b));
      length += (at(a) - at(b)).norm();
    }
  }
  return length > 0 ? Point(sum / length) : area_centroid(tooth.mesh);
}

double lowest_of_crown(const CompletedTooth& tooth) {
  double lowest = std::numeric_limits<double>::max();
  for (std::size_t v = 0; v < tooth.mesh.vertices.size(); ++v)
    if (tooth.source[v] == VertexSource::scan)
      lowest = std::min(lowest, tooth.record.frame.growth_axis.dot(tooth.mesh.vertices[v]));
  return lowest;
}

}  // namespace rhizodont
