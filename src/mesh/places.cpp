// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "mesh/places.hpp"
#include "mesh/mesh_checks.hpp"

#include <algorithm>
#include <cassert>
#include <numeric>

namespace rhizodont {

std::vector<int> first_at_place(const std::vector<Point>& points) {
  assert(is_finite(points));
  std::vector<int> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  const auto at = [&](int v) -> const Point& { return points[static_cast<std::size_t>(v)]; };
  std::sort(order.begin(), order.end(), [&](int i, int j) {
    if (at(i) == at(j)) return i < j;
    return std::lexicographical_compare(at(i).data(), at(i).data() + 3, at(j).data(), at(j).data() + 3);
  });
  std::vector<int> first(points.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    const bool same = k > 0 && at(order[k]) == at(order[k - 1]);
    first[static_cast<std::size_t>(order[k])] = same ? first[static_cast<std::size_t>(order[k - 1])] : order[k];
  }
  return first;
}

}  // namespace rhizodont
