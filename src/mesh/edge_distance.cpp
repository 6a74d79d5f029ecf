// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/edge_distance.hpp"

#include <functional>
#include <queue>
#include <utility>

namespace rhizodont {

std::vector<double> distances_along_edges(const TriangleMesh& mesh, const std::vector<int>& sources, double limit) {
  const std::size_t n = mesh.vertices.size();
  std::vector<std::vector<int>> around(n);
  for (const Triangle& t : mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      // Both ways: at a border no other triangle has the edge the other way round.
      around[static_cast<std::size_t>(t[i])].push_back(t[(i + 1) % 3]);
      around[static_cast<std::size_t>(t[(i + 1) % 3])].push_back(t[i]);
    }
  std::vector<double> distance(n, std::numeric_limits<double>::infinity());
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  for (const int v : sources) {
    distance[static_cast<std::size_t>(v)] = 0;
    queue.push({0, v});
  }
  while (!queue.empty()) {
    const auto [d, v] = queue.top();
    queue.pop();
    if (d > distance[static_cast<std::size_t>(v)]) continue;
    for (const int w : around[static_cast<std::size_t>(v)]) {
      const double there =
          d + (mesh.vertices[static_cast<std::size_t>(v)] - mesh.vertices[static_cast<std::size_t>(w)]).norm();
      if (there >= distance[static_cast<std::size_t>(w)] || there > limit) continue;
      distance[static_cast<std::size_t>(w)] = there;
      queue.push({there, w});
    }
  }
  return distance;
}

}  // namespace rhizodont
