// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "skirt/border.hpp"

#include "mesh/adjacency.hpp"
#include "mesh/disjoint_sets.hpp"

#include <algorithm>
#include <map>

namespace rhizodont {

CrownBorder crown_border(const TriangleMesh& mesh) {
  const EdgeTable edges = edge_table(mesh);
  DisjointSets sets(mesh.vertices.size());
  std::vector<bool> at_border(mesh.vertices.size(), false);
  std::map<int, double> length;
  for (int pass = 0; pass < 2; ++pass) {
    for (std::size_t e = 0; e < edges.size(); ++e) {
      if (edges.triangle_count(e) != 1) continue;
      const auto [a, b] = edges.vertices[e];
      if (pass == 0) {
        at_border[static_cast<std::size_t>(a)] = at_border[static_cast<std::size_t>(b)] = true;
        sets.join(a, b);
      } else {
        length[sets.find(a)] +=
            (mesh.vertices[static_cast<std::size_t>(a)] - mesh.vertices[static_cast<std::size_t>(b)]).norm();
      }
    }
  }
  if (length.empty()) return {};
  const int longest = std::max_element(length.begin(), length.end(), [](const auto& x, const auto& y) {
                        return x.second < y.second;
                      })->first;
  CrownBorder border;
  for (int v = 0; v < static_cast<int>(at_border.size()); ++v) {
    if (!at_border[static_cast<std::size_t>(v)]) continue;
    border.all.push_back(v);
    if (sets.find(v) == longest) border.outer.push_back(v);
  }
  return border;
}

}  // namespace rhizodont
