// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "isosurface/goldberg.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

namespace rhizodont {
namespace {

constexpr double e = 0.7;
const GoldbergTiling tiling(e, Point(0.1, 0.2, 0.3));

std::set<LatticeVertex> corner_set(const LatticeCell& cell) {
  const auto corners = GoldbergTiling::corners(cell);
  return {corners.begin(), corners.end()};
}

TEST(GoldbergTiling, EveryCellHasTheStatedEdgesAndVolume) {
  for (const LatticeCell& cell : GoldbergTiling::around({3, 5, -7})) {
    const auto corners = GoldbergTiling::corners(cell);
    std::array<Point, 4> p;
    std::ranges::transform(corners, p.begin(), [](const LatticeVertex& v) { return tiling.position(v); });
    const double a = std::sqrt(2.0) / 4.0 * e;
    for (std::size_t c = 0; c < 4; ++c) EXPECT_NEAR((p[c] - p[(c + 1) % 4]).norm(), 3.0 * a, 1e-12);
    EXPECT_NEAR((p[0] - p[2]).norm(), std::sqrt(1.5) * e, 1e-12);
    EXPECT_NEAR((p[1] - p[3]).norm(), std::sqrt(1.5) * e, 1e-12);
    // A prism over a triangle of side e holds one cell per height a.
    const double six_volumes = std::abs((p[1] - p[0]).cross(p[2] - p[0]).dot(p[3] - p[0]));
    EXPECT_NEAR(six_volumes / 6.0, std::sqrt(3.0) / 4.0 * e * e * a, 1e-12);
  }
}

TEST(GoldbergTiling, VerticesStandInColumnsOverATriangularLattice) {
  const Point origin = tiling.position({0, 0, 0});
  const double a = std::sqrt(2.0) / 4.0 * e;
  EXPECT_TRUE((tiling.position({1, 1, 1}) - origin).isApprox(Eigen::Vector3d(0.0, 0.0, 3.0 * a), 1e-12));
  const Eigen::Vector3d along_cube = tiling.position({2, 0, 0}) - origin;
  EXPECT_NEAR(along_cube.head<2>().norm(), e, 1e-12);
  EXPECT_NEAR(along_cube.z(), 2.0 * a, 1e-12);
}

TEST(GoldbergTiling, AcrossSharesTheFaceAndComesBack) {
  for (const LatticeCell& cell : GoldbergTiling::around({2, 4, 0})) {
    const auto corners = GoldbergTiling::corners(cell);
    for (int opposite = 0; opposite < 4; ++opposite) {
      const LatticeCell next = GoldbergTiling::across(cell, opposite);
      const auto there = corner_set(next);
      int shared = 0;
      for (int c = 0; c < 4; ++c) {
        const bool has = there.contains(corners[static_cast<std::size_t>(c)]);
        EXPECT_EQ(has, c != opposite);
        shared += has ? 1 : 0;
      }
      EXPECT_EQ(shared, 3);
      const auto next_corners = GoldbergTiling::corners(next);
      const auto other = std::ranges::find_if(
          next_corners, [&](const LatticeVertex& v) { return std::ranges::count(corners, v) == 0; });
      ASSERT_NE(other, next_corners.end());
      EXPECT_EQ(GoldbergTiling::across(next, static_cast<int>(other - next_corners.begin())), cell);
    }
  }
}

TEST(GoldbergTiling, TwentyFourCellsMeetAtAVertexAndFillSpaceAroundIt) {
  std::set<std::set<LatticeVertex>> cells;
  double solid_angle = 0.0;
  const LatticeVertex vertex{1, 3, -5};
  for (const LatticeCell& cell : GoldbergTiling::around(vertex)) {
    auto corners = corner_set(cell);
    EXPECT_TRUE(corners.contains(vertex));
    cells.insert(corners);
    corners.erase(vertex);
    std::vector<Eigen::Vector3d> to;
    for (const LatticeVertex& v : corners) to.push_back((tiling.position(v) - tiling.position(vertex)).normalized());
    // Solid angle of a trihedron (van Oosterom and Strackee 1983).
    solid_angle += 2.0 * std::atan2(std::abs(to[0].cross(to[1]).dot(to[2])),
                                    1.0 + to[0].dot(to[1]) + to[1].dot(to[2]) + to[2].dot(to[0]));
  }
  EXPECT_EQ(cells.size(), 24U);
  EXPECT_NEAR(solid_angle, 4.0 * std::numbers::pi, 1e-9);
}

TEST(GoldbergTiling, NearestVertexIsNearerThanAllNeighbours) {
  for (int i = 0; i < 200; ++i) {
    const Point p(std::sin(1.0 * i) * 5.0, std::sin(2.3 * i) * 5.0, std::sin(3.7 * i) * 5.0);
    const LatticeVertex nearest = tiling.nearest(p);
    const double distance = (tiling.position(nearest) - p).norm();
    for (const LatticeCell& cell : GoldbergTiling::around(nearest))
      for (const LatticeVertex& v : GoldbergTiling::corners(cell))
        EXPECT_LE(distance, (tiling.position(v) - p).norm() + 1e-12);
  }
}

TEST(GoldbergTiling, KeysDiffer) {
  std::set<std::uint64_t> keys;
  std::size_t count = 0;
  for (std::int32_t x = -2; x <= 2; ++x)
    for (std::int32_t y = -2; y <= 2; ++y)
      for (std::int32_t type = 0; type < 6; ++type, ++count)
        keys.insert(GoldbergTiling::key(LatticeCell{{x, y, -x}, type}));
  EXPECT_EQ(keys.size(), count);
}

}  // namespace
}  // namespace rhizodont
