// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "fusion/edge_lengths.hpp"

#include <algorithm>
#include <limits>

namespace rhizodont {

double EdgeLengths::at(const Point& p) const {
  if (box_.squaredExteriorDistance(p) > reach_ * reach_) return root_;
  double longest = std::numeric_limits<double>::max();
  double wanted = root_;
  for (const Source& s : sources_) {
    const double distance = (p - s.middle).norm();
    longest = std::min(longest, s.length + growth_ * distance);
    wanted = std::max(wanted, s.length - shrinkage_ * distance);
  }
  return std::min(longest, wanted);
}

EdgeLengths::EdgeLengths(const TriangleMesh& crown, const CrownBorder& border, double root, double growth,
                         double shrinkage)
    : root_(root), growth_(growth), shrinkage_(shrinkage) {
  double longest = root;
  for (const auto& [from, to] : border.half_edges) {
    const Point& a = crown.vertices[static_cast<std::size_t>(from)];
    const Point& b = crown.vertices[static_cast<std::size_t>(to)];
    sources_.push_back({0.5 * (a + b), (a - b).norm()});
    box_.extend(sources_.back().middle);
    longest = std::max(longest, sources_.back().length);
  }
  reach_ = std::max(root / growth, (longest - root) / shrinkage);
}

}  // namespace rhizodont
