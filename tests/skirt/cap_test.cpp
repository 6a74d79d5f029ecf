// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "skirt/cap.hpp"

#include "mesh/geometry.hpp"
#include "mesh/test_meshes.hpp"
#include "rhizodont/error.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <cmath>

namespace rhizodont {
namespace {

constexpr double base = -1;  // mm, height of the flat base

/// A dome closed by a flat base: a ball whose lower part is pressed onto a plane.
TriangleMesh flat_dome() {
  TriangleMesh mesh = test::sphere(4, 5);
  for (Point& p : mesh.vertices) p.z() = std::max(p.z(), base);
  return mesh;
}

bool lies_on_base(const TriangleMesh& mesh, const Triangle& t) {
  for (const int v : t)
    if (mesh.vertices[static_cast<std::size_t>(v)].z() > base) return false;
  return true;
}

TEST(Cap, IsTheFlatBaseOfADome) {
  const TriangleMesh mesh = flat_dome();
  const Cap cap = find_cap(mesh, Eigen::Vector3d::UnitZ());
  require_cap(cap);
  double wrong = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (cap.is_cap[t] != lies_on_base(mesh, mesh.triangles[t])) wrong += triangle_area(mesh, t);
  EXPECT_LT(wrong, 0.02 * surface_area(mesh));
  EXPECT_GT(cap.flatness, 0.97);
  EXPECT_GT(-cap.direction.z(), 0.99);
  EXPECT_LT(cap.curvature, 0.05);
}

TEST(Cap, IsFoundWithAnAxisThatIsOffByTwentyDegreesAndInAnyPose) {
  const TriangleMesh upright = flat_dome();
  const Cap expected = find_cap(upright, Eigen::Vector3d::UnitZ());
  const Eigen::AngleAxisd off(20 * M_PI / 180, Eigen::Vector3d::UnitX());
  EXPECT_EQ(find_cap(upright, off * Eigen::Vector3d::UnitZ()).is_cap, expected.is_cap);
  const Eigen::AngleAxisd turn(1.1, Eigen::Vector3d(1, -2, 0.5).normalized());
  TriangleMesh turned = upright;
  for (Point& p : turned.vertices) p = turn * p + Point(3, 40, -7);
  EXPECT_EQ(find_cap(turned, turn * Eigen::Vector3d::UnitZ()).is_cap, expected.is_cap);
}

TEST(Cap, ABallAndAWholeToothHaveNone) {
  EXPECT_THROW(require_cap(find_cap(test::sphere(4, 5), Eigen::Vector3d::UnitZ())), InputError);
  TriangleMesh tooth = test::sphere(4, 4);
  for (Point& p : tooth.vertices) p.z() *= p.z() > 0 ? 1 : 3.2;  // a round crown on a long root
  EXPECT_THROW(require_cap(find_cap(tooth, Eigen::Vector3d::UnitZ())), InputError);
}

}  // namespace
}  // namespace rhizodont
