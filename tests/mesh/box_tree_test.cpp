// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/box_tree.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace rhizodont {
namespace {

using Pairs = std::vector<std::pair<int, int>>;

std::vector<ClosedBox> random_boxes(std::size_t count, double size, unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> place(0, 10), side(0, size);
  std::vector<ClosedBox> boxes(count);
  for (ClosedBox& box : boxes)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      box.low[axis] = place(engine);
      box.high[axis] = box.low[axis] + side(engine);
    }
  return boxes;
}

Pairs sorted(Pairs pairs) {
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

const auto any = [](int, int) { return true; };

TEST(BoxTree, FindsEveryMeetingPairOnce) {
  for (const std::size_t count : {0U, 1U, 2U, 6U, 7U, 13U, 100U, 5000U}) {
    const auto boxes = random_boxes(count, 0.5, 1);
    Pairs expected;
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t j = i + 1; j < count; ++j)
        if (boxes[i].meets(boxes[j])) expected.emplace_back(static_cast<int>(i), static_cast<int>(j));
    EXPECT_EQ(sorted(BoxTree(boxes).meeting_pairs(any)), expected) << count;
  }
}

TEST(BoxTree, FindsPairsOfTwoTrees) {
  const auto first = random_boxes(700, 0.5, 2), second = random_boxes(90, 3, 3);
  Pairs expected;
  for (std::size_t i = 0; i < first.size(); ++i)
    for (std::size_t j = 0; j < second.size(); ++j)
      if (first[i].meets(second[j])) expected.emplace_back(static_cast<int>(i), static_cast<int>(j));
  const BoxTree a(first), b(second), none({});
  EXPECT_EQ(sorted(a.meeting_pairs(b, any)), expected);
  EXPECT_TRUE(a.meeting_pairs(none, any).empty());
  EXPECT_TRUE(none.meeting_pairs(a, any).empty());
}

TEST(BoxTree, BoxesThatOnlyTouchMeet) {
  const BoxTree tree({{{0, 0, 0}, {1, 1, 1}}, {{1, 1, 1}, {2, 2, 2}}, {{1.1, 0, 0}, {2, 0.9, 1}}});
  EXPECT_EQ(sorted(tree.meeting_pairs(any)), (Pairs{{0, 1}}));
}

TEST(BoxTree, EqualBoxesAllMeet) {
  const BoxTree tree(std::vector<ClosedBox>(200, {{1, 2, 3}, {1, 2, 3}}));
  EXPECT_EQ(tree.meeting_pairs(any).size(), 200U * 199U / 2);
}

TEST(BoxTree, KeepsWhatIsAskedForAlwaysInTheSameOrder) {
  const auto boxes = random_boxes(4000, 0.6, 4);
  const auto odd = [](int i, int j) { return (i + j) % 2 == 1; };
  const Pairs once = BoxTree(boxes).meeting_pairs(odd);
  EXPECT_FALSE(once.empty());
  EXPECT_TRUE(std::all_of(once.begin(), once.end(), [&](const auto& pair) { return odd(pair.first, pair.second); }));
  EXPECT_EQ(BoxTree(boxes).meeting_pairs(odd), once);
}

}  // namespace
}  // namespace rhizodont
