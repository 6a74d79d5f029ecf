// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "networks/neighbours.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <set>

#include "rhizodont/error.hpp"

namespace rhizodont {
namespace {

std::vector<float> random_points(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(-1, 1);
  std::vector<float> xyz(3 * count);
  for (float& x : xyz) x = uniform(random);
  return xyz;
}

double squared_distance(const std::vector<float>& a, std::size_t i, const std::vector<float>& b, std::size_t j) {
  double sum = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double d = static_cast<double>(a[3 * i + axis]) - static_cast<double>(b[3 * j + axis]);
    sum += d * d;
  }
  return sum;
}

/// Keys by distance, then by index.
std::vector<std::int32_t> sorted_keys(const std::vector<float>& queries, std::size_t q,
                                      const std::vector<float>& keys) {
  std::vector<std::int32_t> order(keys.size() / 3);
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](std::int32_t a, std::int32_t b) {
    return squared_distance(queries, q, keys, static_cast<std::size_t>(a)) <
           squared_distance(queries, q, keys, static_cast<std::size_t>(b));
  });
  return order;
}

TEST(Neighbours, ClosestAgreesWithBruteForceForAnySize) {
  for (const std::size_t keys : {1, 2, 15, 16, 17, 200}) {
    for (const std::size_t queries : {0, 1, 3, 4, 5, 63}) {
      const auto a = random_points(queries, 1), b = random_points(keys, 2);
      const auto found = closest_keys(a, b);
      ASSERT_EQ(found.size(), queries);
      for (std::size_t q = 0; q < queries; ++q) EXPECT_EQ(found[q], sorted_keys(a, q, b).front());
    }
  }
}

TEST(Neighbours, TiesGoToTheSmallerIndex) {
  std::vector<float> keys;
  for (int i = 0; i < 40; ++i) keys.insert(keys.end(), {1, 2, 3});
  const std::vector<float> query{0, 0, 0};
  EXPECT_EQ(closest_keys(query, keys), std::vector<std::int32_t>{0});
  EXPECT_EQ(nearest_keys(query, keys, 3), (std::vector<std::int32_t>{0, 1, 2}));
}

TEST(Neighbours, NearestAgreesWithSorting) {
  const auto queries = random_points(20, 3), keys = random_points(101, 4);
  for (const int k : {1, 7, 16, 101}) {
    const auto found = nearest_keys(queries, keys, k);
    for (std::size_t q = 0; q < 20; ++q) {
      const auto expected = sorted_keys(queries, q, keys);
      for (std::size_t i = 0; i < static_cast<std::size_t>(k); ++i)
        EXPECT_EQ(found[q * static_cast<std::size_t>(k) + i], expected[i]);
    }
  }
  EXPECT_THROW(nearest_keys(queries, keys, 102), UsageError);
  EXPECT_THROW(closest_keys(queries, {}), UsageError);
}

TEST(Neighbours, FarthestPointsOnALine) {
  std::vector<float> line;
  for (int i = 0; i <= 8; ++i) line.insert(line.end(), {static_cast<float>(i), 0, 0});
  // both ends are as far from the centroid: the smaller x wins; then the other end, the middle, the quarters
  EXPECT_EQ(farthest_point_order(line, 5), (std::vector<std::int32_t>{0, 8, 4, 2, 6}));
  EXPECT_THROW(farthest_point_order(line, 10), UsageError);
}

TEST(Neighbours, FarthestPointsDoNotDependOnTheGivenOrder) {
  const auto xyz = random_points(90, 5);
  std::vector<std::size_t> shuffled(90);
  std::iota(shuffled.begin(), shuffled.end(), 0);
  std::shuffle(shuffled.begin(), shuffled.end(), std::mt19937(6));
  std::vector<float> other;
  for (const std::size_t i : shuffled) other.insert(other.end(), {xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]});
  const auto first = farthest_point_order(xyz, 90), second = farthest_point_order(other, 90);
  for (std::size_t i = 0; i < 90; ++i)
    EXPECT_EQ(first[i], static_cast<std::int32_t>(shuffled[static_cast<std::size_t>(second[i])]));
}

TEST(Neighbours, FarthestPointsNested) {
  const auto xyz = random_points(300, 7);
  const auto order = farthest_point_order(xyz, 100);
  std::vector<float> chosen;
  for (const std::int32_t i : order) chosen.insert(chosen.end(), xyz.begin() + 3 * i, xyz.begin() + 3 * i + 3);
  // each next point is at least as near to those before it as the one before was
  double before = 1e9;
  for (std::size_t i = 1; i < 100; ++i) {
    double nearest = 1e9;
    for (std::size_t j = 0; j < i; ++j) nearest = std::min(nearest, squared_distance(chosen, i, chosen, j));
    EXPECT_LE(nearest, before + 1e-6);
    before = nearest;
  }
}

TEST(Neighbours, CoincidingPointsAreEachChosenOnce) {
  const std::vector<float> same(3 * 20, 0.5F);
  const auto order = farthest_point_order(same, 20);
  EXPECT_EQ(std::set<std::int32_t>(order.begin(), order.end()).size(), 20U);
}

}  // namespace
}  // namespace rhizodont
