// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <numeric>
#include <vector>

namespace rhizodont {

/// Sets of the numbers 0 .. size - 1, each alone at first (Tarjan and van Leeuwen 1984, path halving).
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t size) : parent_(size) { std::iota(parent_.begin(), parent_.end(), 0); }

  /// The member that stands for x's set.
  int find(int x) {
    while (parent_[static_cast<std::size_t>(x)] != x) {
      int& up = parent_[static_cast<std::size_t>(x)];
      up = parent_[static_cast<std::size_t>(up)];
      x = up;
    }
    return x;
  }
  /// The member that stands for b's set stands for both from then on. False if they were one already.
  bool join(int a, int b) {
    a = find(a);
    b = find(b);
    parent_[static_cast<std::size_t>(a)] = b;
    return a != b;
  }

 private:
  std::vector<int> parent_;
};

}  // namespace rhizodont
