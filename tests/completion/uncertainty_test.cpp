// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "completion/uncertainty.hpp"

#include <gtest/gtest.h>

#include "rhizodont/error.hpp"
#include "teeth/prepared_crown.hpp"

namespace rhizodont {
namespace {

PredictedTooth column() {
  PredictedTooth predicted;
  for (int i = 0; i < 100; ++i) {
    predicted.cloud.points.emplace_back(0.01 * (i % 7), 0, -0.1 * i);
    predicted.cloud.normals.emplace_back(1, 0, 0);
    predicted.expected_distance.push_back(i < 84 ? 0.5 : 2.0);
  }
  return predicted;
}

TEST(Uncertainty, ApexIsTheMeanOfTheDeepestPoints) {
  const PredictedTooth predicted = column();
  EXPECT_NEAR(expected_distance_at_apex(predicted, Eigen::Vector3d::UnitZ()), 2.0, 1e-12);
  EXPECT_NEAR(expected_distance_at_apex(predicted, -Eigen::Vector3d::UnitZ()), 0.5, 1e-12);
}

TEST(Uncertainty, NoneOnTheCrownAndTheNetworksFarFromIt) {
  TriangleMesh crown;
  crown.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  crown.triangles = {{0, 1, 2}};
  TriangleMesh tooth = crown;
  tooth.vertices.emplace_back(0, 0, -0.1);
  tooth.vertices.emplace_back(0, 0, -5);
  tooth.vertices.emplace_back(0, 0, -9.9);
  const auto u = expected_distances(tooth, prepare_crown(crown), column(), 2.0);
  ASSERT_EQ(u.size(), 6U);
  for (int v = 0; v < 3; ++v) EXPECT_EQ(u[static_cast<std::size_t>(v)], 0);
  EXPECT_GT(u[3], 0);
  EXPECT_LT(u[3], 0.01);
  EXPECT_NEAR(u[4], 0.5, 1e-2);
  EXPECT_NEAR(u[5], 2.0, 1e-6);
}

TEST(Uncertainty, AnIntervalHoldsTheLengthAndHasRootsLengths) {
  const UncertaintyScales scales{-1.5, 0.5, 1, 1};
  EXPECT_EQ(length_interval(12, 2, scales), std::pair(9.0, 13.0));
  EXPECT_EQ(length_interval(4, 2, scales), std::pair(3.0, 5.0)) << "no root is shorter";
  EXPECT_EQ(length_interval(1.5, 1, scales), std::pair(1.5, 3.0)) << "but this one is";
  const auto [low, high] = length_interval(45, 1, scales);
  EXPECT_LE(low, 45);
  EXPECT_EQ(high, 45);
  const auto [least, most] = length_interval(12, 4, {0.5, 1, 1, 1});  // scales may lie on one side of 0
  EXPECT_EQ(least, 12);
  EXPECT_EQ(most, 16);
}

TEST(Uncertainty, ScalesGoThroughTheWeightFile) {
  std::map<std::string, std::string> metadata;
  EXPECT_FALSE(uncertainty_scales(metadata));
  note_uncertainty_scales({-1.25, 0.75, 1.5, 0.4}, metadata);
  const auto scales = uncertainty_scales(metadata);
  ASSERT_TRUE(scales);
  EXPECT_EQ(scales->length_low, -1.25);
  EXPECT_EQ(scales->length_high, 0.75);
  EXPECT_EQ(scales->apex, 1.5);
  EXPECT_EQ(scales->surface, 0.4);
  note_uncertainty_scales({-1.25, 0.75, 1.5, 0.4}, metadata, {{24, {-1, 2, 3, 9}}});
  const auto upper_4 = uncertainty_scales(metadata, 14), upper_5 = uncertainty_scales(metadata, 15);
  ASSERT_TRUE(upper_4 && upper_5);
  EXPECT_EQ(upper_4->length_low, -1) << "left and right are one type";
  EXPECT_EQ(upper_4->length_high, 2);
  EXPECT_EQ(upper_4->apex, 3);
  EXPECT_EQ(upper_4->surface, 0.4) << "that of all teeth";
  EXPECT_EQ(upper_5->apex, 1.5) << "no scales of its own";
  EXPECT_EQ(uncertainty_scales(metadata)->apex, 1.5);
  note_uncertainty_scales({-1.25, 0.75, 1.5, 0.4}, metadata);
  EXPECT_EQ(uncertainty_scales(metadata, 14)->apex, 1.5) << "what types had before is gone";
  metadata["uncertainty.types"] = "1; 24 -1 2";
  EXPECT_THROW(uncertainty_scales(metadata, 24), InputError);
  metadata["uncertainty.types"] = "2; 24 -1 2 3";
  EXPECT_THROW(uncertainty_scales(metadata, 24), InputError);
  metadata["uncertainty.apex"] = "much";
  EXPECT_THROW(uncertainty_scales(metadata), InputError);
}

}  // namespace
}  // namespace rhizodont
