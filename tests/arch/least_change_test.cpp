// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "arch/least_change.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace rhizodont {
namespace {

Eigen::VectorXd all(int count, double value) { return Eigen::VectorXd::Constant(count, value); }

TEST(LeastChange, NothingWishedNothingDone) {
  EXPECT_TRUE(least_change({}, all(3, -1), all(3, 1), 1e3).isZero(0));
  EXPECT_TRUE(least_change({{{{0, 1.0}, {2, -1.0}}, -0.1}}, all(3, -1), all(3, 1), 1e3).isZero(0)) << "it holds";
}

TEST(LeastChange, SharedByFactors) {
  const Eigen::VectorXd x = least_change({{{{0, 1.0}, {2, -2.0}}, 1.0}}, all(3, -9), all(3, 9), 1e9);
  EXPECT_NEAR(x[0], 0.2, 1e-6);
  EXPECT_EQ(x[1], 0);
  EXPECT_NEAR(x[2], -0.4, 1e-6);
}

TEST(LeastChange, TheBoxHoldsAndOthersDoTheRest) {
  const Eigen::VectorXd x = least_change({{{{0, 1.0}, {1, 1.0}}, 1.0}}, all(2, -0.3), Eigen::Vector2d(0.3, 5), 1e9);
  EXPECT_NEAR(x[0], 0.3, 1e-12);
  EXPECT_NEAR(x[1], 0.7, 1e-6);
  EXPECT_EQ(least_change({}, all(1, 0.5), all(1, 2), 1)[0], 0.5) << "a box without 0";
}

TEST(LeastChange, WishesThatCannotBeAreLeft) {
  const Eigen::VectorXd x =
      least_change({{{{0, 1.0}}, 1.0}, {{{0, -1.0}}, 1.0}, {{}, 4.0}}, all(1, -9), all(1, 9), 1e4);
  EXPECT_NEAR(x[0], 0, 1e-6);
}

TEST(LeastChange, NothingNearbyIsBetter) {
  std::mt19937 engine(1);
  std::uniform_real_distribution<double> number(-1, 1);
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<LinearWish> wishes;
    for (int k = 0; k < 12; ++k) {
      wishes.push_back({{}, number(engine) + 0.3});
      for (int i = 0; i < 6; ++i) wishes.back().terms.emplace_back(i, number(engine));
    }
    constexpr double weight = 300;
    const auto merit = [&](const Eigen::VectorXd& x) {
      double sum = x.squaredNorm();
      for (const LinearWish& wish : wishes) {
        double missing = wish.least;
        for (const auto& [i, factor] : wish.terms) missing -= factor * x[i];
        sum += weight * std::max(0.0, missing) * std::max(0.0, missing);
      }
      return sum;
    };
    const Eigen::VectorXd x = least_change(wishes, all(6, -0.8), all(6, 0.8), weight);
    for (int k = 0; k < 300; ++k) {
      Eigen::VectorXd y = x;
      for (int i = 0; i < 6; ++i) y[i] = std::clamp(y[i] + (k % 2 ? 0.1 : 0.003) * number(engine), -0.8, 0.8);
      EXPECT_GE(merit(y), merit(x) - 1e-6);
    }
  }
}

}  // namespace
}  // namespace rhizodont
