// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "arch/least_change.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace rhizodont {
namespace {

Eigen::VectorXd all(int count, double value) { return Eigen::VectorXd::Constant(count, value); }

constexpr WishPrice hard{1e8, 1e9};

TEST(LeastChange, NothingWishedNothingDone) {
  EXPECT_TRUE(least_change({}, all(3, -1), all(3, 1)).isZero(0));
  EXPECT_TRUE(least_change({{{{0, 1.0}, {2, -1.0}}, -0.1}}, all(3, -1), all(3, 1)).isZero(0)) << "it holds";
}

TEST(LeastChange, SharedByFactors) {
  const Eigen::VectorXd x = least_change({{{{0, 1.0}, {2, -2.0}}, 1.0, hard}}, all(3, -9), all(3, 9));
  EXPECT_NEAR(x[0], 0.2, 1e-6);
  EXPECT_EQ(x[1], 0);
  EXPECT_NEAR(x[2], -0.4, 1e-6);
}

TEST(LeastChange, TheBoxHoldsAndOthersDoTheRest) {
  const Eigen::VectorXd x = least_change({{{{0, 1.0}, {1, 1.0}}, 1.0, hard}}, all(2, -0.3), Eigen::Vector2d(0.3, 5));
  EXPECT_NEAR(x[0], 0.3, 1e-6);
  EXPECT_NEAR(x[1], 0.7, 1e-6);
  EXPECT_EQ(least_change({}, all(1, 0.5), all(1, 2))[0], 0.5) << "a box without 0";
}

TEST(LeastChange, WishesThatCannotBeAreLeft) {
  const Eigen::VectorXd x = least_change({{{{0, 1.0}}, 1.0}, {{{0, -1.0}}, 1.0}, {{}, 4.0}}, all(1, -9), all(1, 9));
  EXPECT_NEAR(x[0], 0, 1e-6);
}

TEST(LeastChange, NoMoreIsPaidThanTheMost) {
  // A unit of this wish takes 20 units of change: at 40 a unit, one is worth it, for the next would cost more.
  const Eigen::VectorXd x = least_change({{{{0, 0.05}}, 1.0}}, all(1, -99), all(1, 99));
  EXPECT_NEAR(x[0], 0.5 * 40 * 0.05, 1e-9);
  EXPECT_NEAR(least_change({{{{0, 1.0}}, 4.0}}, all(1, -99), all(1, 99))[0], 4, 2e-3) << "worth the while";
}

TEST(LeastChange, PricesGoOnSmoothly) {
  const WishPrice price{100, 4};
  EXPECT_DOUBLE_EQ(price_of(0.01, price), 0.01);
  EXPECT_DOUBLE_EQ(price_of(0.02, price), 0.04);
  EXPECT_NEAR(price_of(0.02 + 1e-6, price) - price_of(0.02, price), 4e-6, 1e-9);
  EXPECT_DOUBLE_EQ(price_of(1.02, price), 4.04);
}

TEST(LeastChange, NothingNearbyIsBetter) {
  std::mt19937 engine(1);
  std::uniform_real_distribution<double> number(-1, 1);
  for (int trial = 0; trial < 20; ++trial) {
    const WishPrice price{300, trial % 2 ? 1e9 : 3.0};
    std::vector<LinearWish> wishes;
    for (int k = 0; k < 12; ++k) {
      wishes.push_back({{}, number(engine) + 0.3, price});
      for (int i = 0; i < 6; ++i) wishes.back().terms.emplace_back(i, number(engine));
    }
    const auto merit = [&](const Eigen::VectorXd& x) {
      double sum = x.squaredNorm();
      for (const LinearWish& wish : wishes) {
        double missing = wish.least;
        for (const auto& [i, factor] : wish.terms) missing -= factor * x[i];
        sum += price_of(std::max(0.0, missing), price);
      }
      return sum;
    };
    const Eigen::VectorXd x = least_change(wishes, all(6, -0.8), all(6, 0.8));
    for (int k = 0; k < 300; ++k) {
      Eigen::VectorXd y = x;
      for (int i = 0; i < 6; ++i) y[i] = std::clamp(y[i] + (k % 2 ? 0.1 : 0.003) * number(engine), -0.8, 0.8);
      EXPECT_GE(merit(y), merit(x) - 1e-6);
    }
  }
}

}  // namespace
}  // namespace rhizodont
