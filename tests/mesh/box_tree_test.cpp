// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/box_tree.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
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

TEST(BoxTree, VisitsWhatIsNearerThanTheBound) {
  const auto boxes = random_boxes(900, 0.5, 5), queries = random_boxes(60, 0.2, 6);
  const BoxTree tree(boxes), others(queries);
  double least_of_all = std::numeric_limits<double>::infinity();
  for (const ClosedBox& query : queries) {
    std::vector<int> expected, found;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      const double gap = boxes[i].squared_gap(query);
      EXPECT_EQ(gap == 0, boxes[i].meets(query));
      least = std::min(least, gap);
      if (gap < 0.7) expected.push_back(static_cast<int>(i));
    }
    tree.visit_nearer(query, 0.7, [&](int i, double bound) {
      found.push_back(i);
      return bound;
    });
    std::sort(found.begin(), found.end());
    EXPECT_EQ(found, expected);
    double nearest = std::numeric_limits<double>::infinity();
    tree.visit_nearer(query, nearest,
                      [&](int i, double) { return nearest = boxes[static_cast<std::size_t>(i)].squared_gap(query); });
    EXPECT_EQ(nearest, least);
    least_of_all = std::min(least_of_all, least);
  }
  double nearest = std::numeric_limits<double>::infinity();
  tree.visit_nearer_pairs(others, nearest, [&](int i, int j, double) {
    return nearest = boxes[static_cast<std::size_t>(i)].squared_gap(queries[static_cast<std::size_t>(j)]);
  });
  EXPECT_EQ(nearest, least_of_all);
}

TEST(BoxTree, VisitsEveryPairNearerThanTheBoundOnce) {
  const auto first = random_boxes(300, 0.5, 7), second = random_boxes(40, 2, 8);
  Pairs expected, found;
  for (std::size_t i = 0; i < first.size(); ++i)
    for (std::size_t j = 0; j < second.size(); ++j)
      if (first[i].squared_gap(second[j]) < 0.3) expected.emplace_back(static_cast<int>(i), static_cast<int>(j));
  BoxTree(first).visit_nearer_pairs(BoxTree(second), 0.3, [&](int i, int j, double bound) {
    found.emplace_back(i, j);
    return bound;
  });
  EXPECT_EQ(sorted(found), expected);
  BoxTree(first).visit_nearer_pairs(BoxTree({}), 0.3, [](int, int, double) -> double {
    ADD_FAILURE();
    return 0;
  });
}

}  // namespace
}  // namespace rhizodont
