// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/cross_sections.hpp"

#include "mesh/test_meshes.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace rhizodont {
namespace {

TEST(CrossSections, OfACubeAreItsFace) {
  const std::vector<double> areas = cross_section_areas(test::cube(), Eigen::Vector3d::UnitX(), 0.9, 0.25);
  ASSERT_EQ(areas.size(), 4U);
  for (const double area : areas) EXPECT_NEAR(area, 1, 1e-12);
}

TEST(CrossSections, OfABallFollowTheCircle) {
  const TriangleMesh ball = test::sphere(5, 2);
  const Eigen::Vector3d axis = Eigen::Vector3d(1, 2, 3).normalized();
  const std::vector<double> areas = cross_section_areas(ball, axis, 1.5, 0.5);
  ASSERT_EQ(areas.size(), 7U);
  for (std::size_t k = 0; k < areas.size(); ++k) {
    const double height = 1.5 - 0.5 * static_cast<double>(k);
    EXPECT_NEAR(areas[k], std::numbers::pi * (4 - height * height), 0.03) << height;
  }
}

TEST(CrossSections, OfTwoPiecesCountTogetherWhereverTheyAre) {
  const TriangleMesh two = test::together(test::cube(), test::cube(), Point(70, -30, 0));
  for (const double area : cross_section_areas(two, Eigen::Vector3d::UnitZ(), 0.75, 0.2)) EXPECT_NEAR(area, 2, 1e-9);
}

TEST(CrossSections, AboveTheLevelThereAreNone) {
  EXPECT_TRUE(cross_section_areas(test::cube(), Eigen::Vector3d::UnitZ(), -0.1, 0.2).empty());
}

}  // namespace
}  // namespace rhizodont
