// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace rhizodont {

/// An axis-parallel box with its sides.
struct ClosedBox {
  std::array<double, 3> low, high;

  bool meets(const ClosedBox& other) const {
    // Without branches: most pairs that are asked about are near each other, and none of the six is likelier to decide.
    const auto holds = [](double a, double b) { return static_cast<unsigned>(a <= b); };
    return (holds(low[0], other.high[0]) & holds(other.low[0], high[0]) & holds(low[1], other.high[1]) &
            holds(other.low[1], high[1]) & holds(low[2], other.high[2]) & holds(other.low[2], high[2])) != 0;
  }
  /// mm^2: square of the distance between the two; 0 where they meet.
  double squared_gap(const ClosedBox& other) const {
    double sum = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double gap = std::max({0.0, other.low[axis] - high[axis], low[axis] - other.high[axis]});
      sum += gap * gap;
    }
    return sum;
  }
  /// mm: the longest side.
  double widest() const { return std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]}); }
  /// The least box around both.
  void extend(const ClosedBox& other);
};

/// Boxes in a balanced binary tree, each node split at the median along its widest axis: says which boxes meet and
/// which are near. The tree depends on the boxes alone, not on the number of threads.
class BoxTree {
 public:
  /// Precondition: finite boxes, fewer than 2^31.
  explicit BoxTree(const std::vector<ClosedBox>& boxes);

  bool empty() const { return boxes_.empty(); }

  /// All pairs (i, j) of numbers of boxes with i < j that meet and for which keep(i, j), in no particular order but
  /// always the same. `keep` is called from several threads.
  template <class Keep>
  std::vector<std::pair<int, int>> meeting_pairs(const Keep& keep) const {
    return gathered([&](std::size_t leaf, auto& pairs) {
      for_each_meeting_leaf(bounds_of_leaf(leaf), leaf, [&](std::size_t other) {
        for (std::size_t i = begin_of(leaf); i < begin_of(leaf + 1); ++i)
          for (std::size_t j = other == leaf ? i + 1 : begin_of(other); j < begin_of(other + 1); ++j) {
            if (!boxes_[i].meets(boxes_[j])) continue;
            const auto [low, high] = std::minmax(number_[i], number_[j]);
            if (keep(low, high)) pairs.emplace_back(low, high);
          }
      });
    });
  }

  /// All pairs (i, j) of a box i of this tree and a box j of the other that meet and for which keep(i, j); likewise.
  template <class Keep>
  std::vector<std::pair<int, int>> meeting_pairs(const BoxTree& others, const Keep& keep) const {
    if (others.empty()) return {};
    return gathered([&](std::size_t leaf, auto& pairs) {
      others.for_each_meeting_leaf(bounds_of_leaf(leaf), 0, [&](std::size_t other) {
        for (std::size_t i = begin_of(leaf); i < begin_of(leaf + 1); ++i)
          for (std::size_t j = others.begin_of(other); j < others.begin_of(other + 1); ++j)
            if (boxes_[i].meets(others.boxes_[j]) && keep(number_[i], others.number_[j]))
              pairs.emplace_back(number_[i], others.number_[j]);
      });
    });
  }

  /// Visits boxes whose squared distance from `box` is less than the bound (mm^2), near ones first as far as the tree
  /// tells. `visit(i, bound)` gets the number of a box and the bound, and returns the bound from then on, no larger. In
  /// the caller's thread, in an order that is always the same.
  template <class Visit>
  void visit_nearer(const ClosedBox& box, double squared_bound, const Visit& visit) const {
    if (empty()) return;
    std::array<std::pair<std::size_t, double>, 64> open{};
    std::size_t count = 0;
    open[count++] = {1, nodes_[1].squared_gap(box)};
    while (count > 0) {
      const auto [node, gap] = open[--count];
      if (!(gap < squared_bound)) continue;
      if (node >= leaves_) {
        for (std::size_t i = begin_of(node - leaves_); i < begin_of(node - leaves_ + 1); ++i)
          if (boxes_[i].squared_gap(box) < squared_bound) squared_bound = visit(number_[i], squared_bound);
        continue;
      }
      const double left = nodes_[2 * node].squared_gap(box), right = nodes_[2 * node + 1].squared_gap(box);
      const bool left_first = left <= right;
      open[count++] = left_first ? std::pair(2 * node + 1, right) : std::pair(2 * node, left);
      open[count++] = left_first ? std::pair(2 * node, left) : std::pair(2 * node + 1, right);
    }
  }

  /// Visits pairs (i, j) of a box i of this tree and a box j of the other whose squared distance is less than the
  /// bound; likewise, with `visit(i, j, bound)`.
  template <class Visit>
  void visit_nearer_pairs(const BoxTree& others, double squared_bound, const Visit& visit) const {
    if (empty() || others.empty()) return;
    struct Open {
      std::size_t mine, other;
      double gap;
    };
    std::array<Open, 128> open{};
    std::size_t count = 0;
    const auto opened = [&](std::size_t mine, std::size_t other) {
      return Open{mine, other, nodes_[mine].squared_gap(others.nodes_[other])};
    };
    open[count++] = opened(1, 1);
    while (count > 0) {
      const auto [mine, other, gap] = open[--count];
      if (!(gap < squared_bound)) continue;
      const bool mine_ends = mine >= leaves_, other_ends = other >= others.leaves_;
      if (mine_ends && other_ends) {
        for (std::size_t i = begin_of(mine - leaves_); i < begin_of(mine - leaves_ + 1); ++i)
          for (std::size_t j = others.begin_of(other - others.leaves_); j < others.begin_of(other - others.leaves_ + 1);
               ++j)
            if (boxes_[i].squared_gap(others.boxes_[j]) < squared_bound)
              squared_bound = visit(number_[i], others.number_[j], squared_bound);
        continue;
      }
      const bool split_mine = other_ends || (!mine_ends && nodes_[mine].widest() >= others.nodes_[other].widest());
      Open near = split_mine ? opened(2 * mine, other) : opened(mine, 2 * other);
      Open far = split_mine ? opened(2 * mine + 1, other) : opened(mine, 2 * other + 1);
      if (far.gap < near.gap) std::swap(near, far);
      open[count++] = far;
      open[count++] = near;
    }
  }

 private:
  using Pairs = std::vector<std::pair<int, int>>;

  /// What `find(leaf, pairs)` finds for each leaf, leaf after leaf.
  template <class Find>
  Pairs gathered(const Find& find) const {
    if (empty()) return {};
    constexpr std::size_t leaves_at_once = 16;
    std::vector<Pairs> parts((leaves_ + leaves_at_once - 1) / leaves_at_once);
    tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t part) {
      for (std::size_t leaf = part * leaves_at_once; leaf < std::min(leaves_, (part + 1) * leaves_at_once); ++leaf)
        find(leaf, parts[part]);
    });
    Pairs all;
    for (const Pairs& part : parts) all.insert(all.end(), part.begin(), part.end());
    return all;
  }

  /// Visits the leaves from number `first` on whose box meets `box`.
  template <class Visit>
  void for_each_meeting_leaf(const ClosedBox& box, std::size_t first, const Visit& visit) const {
    std::array<std::size_t, 64> open{};
    std::size_t count = 0;
    open[count++] = 1;
    while (count > 0) {
      const std::size_t node = open[--count];
      if (!nodes_[node].meets(box) || last_leaf_under(node) < first) continue;
      if (node >= leaves_) {
        visit(node - leaves_);
      } else {
        open[count++] = 2 * node;
        open[count++] = 2 * node + 1;
      }
    }
  }

  const ClosedBox& bounds_of_leaf(std::size_t leaf) const { return nodes_[leaves_ + leaf]; }
  std::size_t last_leaf_under(std::size_t node) const;
  /// Of a leaf's boxes in `boxes_`; leaves share them evenly.
  std::size_t begin_of(std::size_t leaf) const { return leaf * boxes_.size() / leaves_; }

  struct Middle {
    std::array<double, 3> at;
    int number;
  };
  void arrange(std::vector<Middle>& middles, std::size_t first_leaf, std::size_t leaf_count) const;

  std::size_t leaves_ = 1;        // a power of two
  std::vector<ClosedBox> nodes_;  // node n has the children 2 n and 2 n + 1; the root is 1, the leaves come last
  std::vector<ClosedBox> boxes_;  // leaf after leaf
  std::vector<int> number_;       // of each in the order given
};

}  // namespace rhizodont
