// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "fusion/edge_lengths.hpp"

#include <algorithm>
#include <limits>

namespace rhizodont {

double EdgeLengths::at(const Point& p) const {
  double longest = std::numeric_limits<double>::max();
  double wanted = root;
  for (const Source& s : sources) {
    const double distance = (p - s.middle).norm();
    longest = std::min(longest, s.length + growth * distance);
    wanted = std::max(wanted, s.length - shrinkage * distance);
  }
  return std::min(longest, wanted);
}

EdgeLengths edge_lengths(const TriangleMesh& crown, const CrownBorder& border, double root_edge) {
  EdgeLengths lengths;
  lengths.root = root_edge;
  for (const auto& [from, to] : border.half_edges) {
    const Point& a = crown.vertices[static_cast<std::size_t>(from)];
    const Point& b = crown.vertices[static_cast<std::size_t>(to)];
    lengths.sources.push_back({0.5 * (a + b), (a - b).norm()});
  }
  return lengths;
}

}  // namespace rhizodont
