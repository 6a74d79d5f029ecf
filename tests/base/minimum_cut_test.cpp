// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "base/minimum_cut.hpp"

#include <gtest/gtest.h>

#include <random>

namespace rhizodont {
namespace {

double cost(const std::vector<bool>& side, const std::vector<double>& cost_true, const std::vector<double>& cost_false,
            const std::vector<CutEdge>& edges) {
  double sum = 0;
  for (std::size_t i = 0; i < side.size(); ++i) sum += side[i] ? cost_true[i] : cost_false[i];
  for (const CutEdge& e : edges)
    if (side[static_cast<std::size_t>(e.a)] != side[static_cast<std::size_t>(e.b)]) sum += e.cost;
  return sum;
}

TEST(MinimumCut, IsTheCheapestOfAllDivisions) {
  std::mt19937 random(1);
  std::uniform_int_distribution<int> price(0, 9);
  constexpr int nodes = 9;
  for (int round = 0; round < 60; ++round) {
    std::vector<double> cost_true, cost_false;
    std::vector<CutEdge> edges;
    for (int i = 0; i < nodes; ++i) {
      cost_true.push_back(price(random));
      cost_false.push_back(price(random));
      for (int j = 0; j < i; ++j)
        if (price(random) < 5) edges.push_back({j, i, static_cast<double>(price(random))});
    }
    double best = 1e9;
    for (int bits = 0; bits < (1 << nodes); ++bits) {
      std::vector<bool> side;
      for (int i = 0; i < nodes; ++i) side.push_back((bits >> i) & 1);
      best = std::min(best, cost(side, cost_true, cost_false, edges));
    }
    EXPECT_EQ(cost(minimum_cut(cost_true, cost_false, edges), cost_true, cost_false, edges), best);
  }
}

TEST(MinimumCut, TiesGoToTheSmallerTrueSide) {
  EXPECT_EQ(minimum_cut({1, 0}, {1, 5}, {}), (std::vector<bool>{false, true}));
}

}  // namespace
}  // namespace rhizodont
