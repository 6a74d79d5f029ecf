// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/box_tree.hpp"

#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>

namespace rhizodont {
namespace {

constexpr std::size_t boxes_per_leaf = 6;  // at most
constexpr std::ptrdiff_t few = 2048;       // boxes that one thread arranges faster than two

}  // namespace

void ClosedBox::extend(const ClosedBox& other) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    low[axis] = std::min(low[axis], other.low[axis]);
    high[axis] = std::max(high[axis], other.high[axis]);
  }
}

BoxTree::BoxTree(const std::vector<ClosedBox>& boxes) : number_(boxes.size()) {
  assert(boxes.size() < std::size_t{1} << 31);
  assert(std::all_of(boxes.begin(), boxes.end(), [](const ClosedBox& box) { return std::isfinite(box.widest()); }));
  if (boxes.empty()) return;
  leaves_ = std::bit_ceil((boxes.size() + boxes_per_leaf - 1) / boxes_per_leaf);
  std::vector<Middle> middles(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      middles[i].at[axis] = 0.5 * boxes[i].low[axis] + 0.5 * boxes[i].high[axis];
    middles[i].number = static_cast<int>(i);
  }
  boxes_.resize(boxes.size());
  arrange(middles, 0, leaves_);
  for (std::size_t k = 0; k < boxes.size(); ++k) {
    number_[k] = middles[k].number;
    boxes_[k] = boxes[static_cast<std::size_t>(number_[k])];
  }
  nodes_.resize(2 * leaves_);
  for (std::size_t leaf = 0; leaf < leaves_; ++leaf) {
    ClosedBox& around = nodes_[leaves_ + leaf];
    around = boxes_[begin_of(leaf)];
    for (std::size_t k = begin_of(leaf) + 1; k < begin_of(leaf + 1); ++k) around.extend(boxes_[k]);
  }
  for (std::size_t node = leaves_; node-- > 1;) {
    nodes_[node] = nodes_[2 * node];
    nodes_[node].extend(nodes_[2 * node + 1]);
  }
}

std::size_t BoxTree::last_leaf_under(std::size_t node) const {
  // The leaves under a node of depth d are 2^(depth of leaves - d) in a row.
  const int below = std::bit_width(leaves_) - std::bit_width(node);
  return ((node + 1) << below) - 1 - leaves_;
}

/// Puts the boxes of some leaves in order: leaf after leaf, halved at the median.
void BoxTree::arrange(std::vector<Middle>& middles, std::size_t first_leaf, std::size_t leaf_count) const {
  if (leaf_count == 1) return;
  const std::size_t half = leaf_count / 2;
  const auto at = [&](std::size_t leaf) { return middles.begin() + static_cast<std::ptrdiff_t>(begin_of(leaf)); };
  const auto begin = at(first_leaf), end = at(first_leaf + leaf_count);
  std::array<double, 3> low = begin->at, high = begin->at;
  for (auto m = begin; m != end; ++m)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], m->at[axis]);
      high[axis] = std::max(high[axis], m->at[axis]);
    }
  std::size_t widest = 0;
  for (std::size_t axis = 1; axis < 3; ++axis)
    if (high[axis] - low[axis] > high[widest] - low[widest]) widest = axis;
  std::nth_element(begin, at(first_leaf + half), end, [widest](const Middle& a, const Middle& b) {
    return a.at[widest] != b.at[widest] ? a.at[widest] < b.at[widest] : a.number < b.number;
  });
  const auto lower = [&] { arrange(middles, first_leaf, half); };
  const auto upper = [&] { arrange(middles, first_leaf + half, half); };
  if (end - begin > few) {
    tbb::parallel_invoke(lower, upper);
  } else {
    lower();
    upper();
  }
}

}  // namespace rhizodont
