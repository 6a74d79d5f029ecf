// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "poisson/neighbours.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "mesh/nearest_vertex.hpp"

namespace rhizodont {

Neighbours nearest_neighbours(std::span<const Point> points, std::size_t count) {
  Neighbours result;
  result.count = std::min(count, points.size() - 1);
  result.indices.resize(points.size() * result.count);
  result.distances.resize(points.size() * result.count);
  const NearestVertexIndex index(std::vector<Point>(points.begin(), points.end()));
  tbb::parallel_for(std::size_t{0}, points.size(), [&](std::size_t i) {
    const auto found = index.nearest(points[i], result.count + 1);
    std::size_t kept = 0;
    for (const NearVertex& near : found) {
      if (near.index == static_cast<int>(i) || kept == result.count) continue;
      result.indices[i * result.count + kept] = near.index;
      result.distances[i * result.count + kept] = std::sqrt(near.squared_distance);
      ++kept;
    }
  });
  return result;
}

}  // namespace rhizodont
