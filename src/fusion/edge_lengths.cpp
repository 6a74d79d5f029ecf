// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "fusion/edge_lengths.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>
#include <vector>

namespace rhizodont {
namespace {

/// The border's half-edges, each followed by the one that goes on from it where there is one left.
std::vector<std::pair<int, int>> along_the_border(const CrownBorder& border) {
  std::map<int, std::vector<int>> leaving;  // ends of those not taken yet by their start
  for (const auto& [from, to] : border.half_edges) leaving[from].push_back(to);
  std::vector<std::pair<int, int>> chain;
  for (auto& [start, ends] : leaving)
    while (!ends.empty()) {
      int from = start;
      for (auto next = leaving.find(from); next != leaving.end() && !next->second.empty(); next = leaving.find(from)) {
        const int to = next->second.back();
        next->second.pop_back();
        chain.emplace_back(from, to);
        from = to;
      }
    }
  return chain;
}

}  // namespace

double EdgeLengths::at(const Point& p) const {
  if (box_.squaredExteriorDistance(p) > reach_ * reach_) return root_;
  double longest = std::numeric_limits<double>::max();
  double wanted = root_;
  for (const Group& group : groups_) {
    constexpr double rounding = 1e-9;  // mm: on the safe side, so that the result is that of all sources
    const double least_distance = group.box.exteriorDistance(p) - rounding;
    if (group.shortest + growth_ * least_distance >= longest && group.longest - shrinkage_ * least_distance <= wanted)
      continue;
    for (std::size_t i = group.begin; i < group.end; ++i) {
      const Source& s = sources_[i];
      const double distance = (p - s.middle).norm();
      longest = std::min(longest, s.length + growth_ * distance);
      wanted = std::max(wanted, s.length - shrinkage_ * distance);
    }
  }
  return std::min(longest, wanted);
}

EdgeLengths::EdgeLengths(const TriangleMesh& crown, const CrownBorder& border, double root, double growth,
                         double shrinkage)
    : root_(root), growth_(growth), shrinkage_(shrinkage) {
  double longest = root;
  for (const auto& [from, to] : along_the_border(border)) {
    const Point& a = crown.vertices[static_cast<std::size_t>(from)];
    const Point& b = crown.vertices[static_cast<std::size_t>(to)];
    sources_.push_back({0.5 * (a + b), (a - b).norm()});
    box_.extend(sources_.back().middle);
    longest = std::max(longest, sources_.back().length);
  }
  constexpr std::size_t size = 12;
  for (std::size_t begin = 0; begin < sources_.size(); begin += size) {
    Group group{begin, std::min(begin + size, sources_.size()), {}, sources_[begin].length, sources_[begin].length};
    for (std::size_t i = group.begin; i < group.end; ++i) {
      group.box.extend(sources_[i].middle);
      group.shortest = std::min(group.shortest, sources_[i].length);
      group.longest = std::max(group.longest, sources_[i].length);
    }
    groups_.push_back(group);
  }
  reach_ = std::max(root / growth, (longest - root) / shrinkage);
}

}  // namespace rhizodont
