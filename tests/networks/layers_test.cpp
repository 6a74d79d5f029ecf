// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "networks/layers.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace rhizodont::networks {
namespace {

Matrix rows(std::initializer_list<std::initializer_list<float>> numbers) { return Matrix(numbers); }

Linear identity(Eigen::Index width) { return Linear(Matrix::Identity(width, width)); }

TEST(Layers, LinearTakesTheWeightAsStored) {
  const std::vector<float> bias{10, 20, 30};
  const Linear layer = Linear::of_transposed(rows({{1, 2}, {3, 4}, {5, 6}}), bias);
  EXPECT_EQ(linear(layer, rows({{1, 0}, {0, 1}, {1, -1}})), rows({{11, 23, 35}, {12, 24, 36}, {9, 19, 29}}));
}

TEST(Layers, MlpHasGeluBetweenItsLayersOnly) {
  const Linear twice(2 * Matrix::Identity(2, 2));
  EXPECT_EQ(multilayer({twice}, rows({{-3, 4}})), rows({{-6, 8}}));
  // Where it is far from zero, GELU keeps what is positive and drops the rest.
  EXPECT_TRUE(multilayer({twice, twice}, rows({{-30, 40}})).isApprox(rows({{0, 160}})));
}

TEST(Layers, ActivatedSumAddsOneRowToAll) {
  EXPECT_TRUE(activated_sum(rows({{10, -50}, {20, 50}}), rows({{10, 10}})).isApprox(rows({{20, 0}, {30, 60}}), 1e-6F));
}

TEST(Layers, LargestOfRows) { EXPECT_EQ(largest_of_rows(rows({{1, -2, -7}, {0, 5, -9}})), rows({{1, 5, -7}})); }

TEST(Layers, LargestOfRowsKeepsWhatIsNotANumber) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const Matrix largest = largest_of_rows(rows({{1, nan, 3}, {nan, 5, -9}, {7, 8, 9}}));
  EXPECT_TRUE(std::isnan(largest(0, 0)));
  EXPECT_TRUE(std::isnan(largest(0, 1)));
  EXPECT_EQ(largest(0, 2), 9);
}

TEST(Layers, EdgeConvolutionTakesTheLargestNeighbourOfEachChannel) {
  const Matrix keys = rows({{1, 8}, {2, -7}, {-3, 6}}), queries = rows({{100, -100}, {0, 0}});
  const EdgeConvolution layer{identity(2), identity(2), {}};
  const std::vector<std::int32_t> neighbours{0, 1, 2, 1};
  // The leak of a negative sum is a fifth.
  EXPECT_TRUE(edge_convolution(layer, keys, queries, neighbours).isApprox(rows({{102, -18.4F}, {2, 6}})));
}

TEST(Layers, AttentionMixesByTheScoresOfEachHead) {
  // Keys are the memory, values ten times the memory; one channel a head.
  Matrix to_memory(2, 4);
  to_memory << Matrix::Identity(2, 2), 10 * Matrix::Identity(2, 2);
  const Attention layer{2, identity(2), Linear(to_memory), identity(2)};
  const float third = std::log(3.0F);
  const Matrix mixed = attention(layer, rows({{1, 0}, {1000, -1000}}), rows({{third, 1}, {0, 2}}));
  // Head 0 of query 0: scores ln 3 and 0, shares 3/4 and 1/4; head 1: equal scores. Query 1 sees one of both alone.
  EXPECT_NEAR(mixed(0, 0), 7.5F * third, 1e-5);
  EXPECT_NEAR(mixed(0, 1), 15, 1e-5);
  EXPECT_NEAR(mixed(1, 0), 10 * third, 1e-5);
  EXPECT_NEAR(mixed(1, 1), 10, 1e-5);
}

TEST(Layers, AttentionScalesByTheWidthOfAHead) {
  Matrix to_memory(4, 8);
  to_memory << Matrix::Identity(4, 4), Matrix::Identity(4, 4);
  const Attention layer{1, identity(4), Linear(to_memory), identity(4)};
  const float third = std::log(3.0F);
  const Matrix mixed = attention(layer, rows({{2, 0, 0, 0}}), rows({{third, 4, 0, 0}, {0, 0, 8, 0}}));
  EXPECT_TRUE(mixed.isApprox(rows({{0.75F * third, 3, 2, 0}}), 1e-5F));
}

}  // namespace
}  // namespace rhizodont::networks
