// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "completion/solidity.hpp"

#include "mesh/test_meshes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace rhizodont {
namespace {

/// A root from z = 0 down to z = -12 with this radius by depth.
TriangleMesh root(const std::function<double(double)>& radius) {
  TriangleMesh mesh = test::sphere(5);
  for (Point& p : mesh.vertices) {
    const double depth = 6 * (1 - p.z());
    const double wide = std::hypot(p.x(), p.y());
    const double scale = wide > 1e-9 ? std::min(wide * 4, 1.0) * radius(depth) / wide : 0;
    p = Point(scale * p.x(), scale * p.y(), -depth);
  }
  return mesh;
}

TEST(Swelling, OfARootThatTapersIsNone) {
  const TriangleMesh cone = root([](double depth) { return 4 - 0.3 * depth; });
  EXPECT_NEAR(swelling(cone, Eigen::Vector3d::UnitZ(), 0), 1, 1e-6);
}

TEST(Swelling, OfADropOnAThreadIsLarge) {
  const TriangleMesh drop =
      root([](double depth) { return depth < 7 ? 4 - 0.55 * depth : 0.15 + 1.2 * std::sin((depth - 7) * 0.6); });
  EXPECT_GT(swelling(drop, Eigen::Vector3d::UnitZ(), 0), 1.5);
}

TEST(Swelling, OfNoRootIsInfinite) {
  const TriangleMesh cone = root([](double depth) { return 4 - 0.3 * depth; });
  EXPECT_TRUE(std::isinf(swelling(cone, Eigen::Vector3d::UnitZ(), -13)));
}

TEST(Solid, IsASurfaceButNotOneWithoutARoot) {
  PredictedTooth tooth;
  for (const Point& p : root([](double depth) { return 4 - 0.3 * depth; }).vertices) {
    tooth.cloud.points.push_back(p);
    tooth.cloud.normals.push_back(Eigen::Vector3d::UnitX());
    tooth.expected_distance.push_back(0);
  }
  const Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
  EXPECT_TRUE(is_solid(solidity(tooth, axis, 0)));
  EXPECT_EQ(solidity(tooth, axis, -13).below, 0) << "all of it lies above";
  EXPECT_FALSE(is_solid(solidity(tooth, axis, -13)));
}

TEST(Swelling, DoesNotDependOnWhereTheToothStands) {
  const TriangleMesh upright = root([](double depth) { return 3 + std::sin(depth); });
  TriangleMesh turned = upright;
  for (Point& p : turned.vertices) p = Point(p.z() + 40, p.x() - 7, p.y() + 3);
  EXPECT_NEAR(swelling(upright, Eigen::Vector3d::UnitZ(), 0), swelling(turned, Eigen::Vector3d::UnitX(), 40), 1e-9);
}

}  // namespace
}  // namespace rhizodont
