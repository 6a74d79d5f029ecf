// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "networks/cloud_grid.hpp"

#include "base/random_stream.hpp"
#include "networks/neighbours.hpp"
#include "networks/scan_sample.hpp"
#include "rhizodont/error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

namespace rhizodont {
namespace {

std::vector<float> points(std::size_t count, std::uint64_t seed, double size) {
  RandomStream random(seed);
  std::vector<float> xyz;
  for (std::size_t i = 0; i < 3 * count; ++i) xyz.push_back(static_cast<float>(random.uniform(-size, size)));
  return xyz;
}

TEST(CloudGrid, FindsTheNearestAsAScanOfAllDoes) {
  const std::vector<float> keys = points(700, 1, 10);
  for (const float cell : {0.4F, 2.0F, 50.0F}) {
    const CloudGrid grid(keys, cell);
    EXPECT_EQ(grid.nearest(keys, 9), nearest_keys(keys, keys, 9));
    const std::vector<float> others = points(200, 2, 16);  // some outside of the grid
    EXPECT_EQ(grid.nearest(others, 5), nearest_keys(others, keys, 5));
  }
}

TEST(CloudGrid, FillsUpWithTheNearest) {
  const std::vector<float> keys{0, 0, 0, 5, 0, 0}, query{1, 0, 0};
  EXPECT_EQ(CloudGrid(keys, 1).nearest(query, 4), (std::vector<std::int32_t>{0, 1, 0, 0}));
  EXPECT_THROW(CloudGrid({}, 1).nearest(query, 1), UsageError);
  EXPECT_THROW(CloudGrid(keys, 1).nearest(query, 65), UsageError);
}

TEST(CloudGrid, ThinnedPointsLieNearTheMiddleOfTheirs) {
  const std::vector<float> xyz{0.1F, 0.1F, 0.1F, 0.4F, 0.4F, 0.4F, 0.9F, 0.9F, 0.9F, 1.5F, 0.2F, 0.2F, -0.1F, 0, 0};
  EXPECT_EQ(thinned(xyz, 1), (std::vector<std::int32_t>{4, 1, 3}));
}

TEST(CloudGrid, RoundingDoesNotChooseWhichPointIsKept) {
  // Two points to a cell: both are equally far from their middle.
  std::vector<float> xyz;
  for (int i = 0; i < 100; ++i) {
    const auto at = static_cast<float>(i);
    xyz.insert(xyz.end(), {at + 0.2F, 0.3F, 0.1F, at + 0.9F, 0.7F, 0.4F});
  }
  const std::vector<std::int32_t> chosen = thinned(xyz, 1);
  RandomStream random(5);
  for (float& x : xyz) x += static_cast<float>(random.uniform(-1e-5, 1e-5));
  EXPECT_EQ(thinned(xyz, 1), chosen);
}

TEST(ScanPyramid, LevelsReferToEachOther) {
  ScanCloud cloud;
  cloud.positions = points(3000, 3, 12);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    cloud.normals.insert(cloud.normals.end(), {0, 0, 1});
    cloud.curvatures.insert(cloud.curvatures.end(), {0.5F, -0.5F});
  }
  const ScanShape shape;
  const ScanPyramid pyramid = scan_pyramid(cloud, shape);
  EXPECT_EQ(pyramid.features.size(), scan_feature_count * pyramid.levels[0].size());
  for (std::size_t l = 0; l < ScanShape::levels; ++l) {
    const ScanLevel& level = pyramid.levels[l];
    ASSERT_GT(level.size(), 0U);
    EXPECT_EQ(level.neighbours.size(), level.size() * 16);
    if (l == 0) continue;
    const ScanLevel& finer = pyramid.levels[l - 1];
    EXPECT_LT(level.size(), finer.size());
    for (std::size_t i = 0; i < level.size(); ++i)
      for (std::size_t a = 0; a < 3; ++a)
        EXPECT_EQ(level.positions[3 * i + a], finer.positions[3 * static_cast<std::size_t>(level.from[i]) + a]);
    for (std::size_t i = 0; i < finer.size(); ++i)
      EXPECT_NEAR(std::accumulate(&finer.above_weights[3 * i], &finer.above_weights[3 * i] + 3, 0.0F), 1, 1e-5);
  }
  cloud.normals.pop_back();
  EXPECT_THROW(scan_pyramid(cloud, shape), InputError);
}

}  // namespace
}  // namespace rhizodont
