// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/random_stream.hpp"
#include "families/crown_crop.hpp"
#include "families/self_crossing.hpp"
#include "mesh/diagnosis.hpp"
#include "mesh/self_intersection.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace rhizodont {
namespace {

// A tube of `rings` rings around z, open at both ends, whose radius is given by height and angle.
template <typename Radius>
TriangleMesh tube(int rings, int sectors, const Radius& radius) {
  TriangleMesh mesh;
  for (int i = 0; i < rings; ++i) {
    for (int j = 0; j < sectors; ++j) {
      const double a = 2 * std::numbers::pi * j / sectors, z = 0.25 * i, r = radius(z, a);
      mesh.vertices.emplace_back(r * std::cos(a), r * std::sin(a), z);
    }
  }
  for (int i = 0; i + 1 < rings; ++i) {
    for (int j = 0; j < sectors; ++j) {
      const int a = i * sectors + j, b = i * sectors + (j + 1) % sectors;
      mesh.triangles.push_back({a, b, a + sectors});
      mesh.triangles.push_back({b, b + sectors, a + sectors});
    }
  }
  return mesh;
}

TEST(SelfCrossing, smoothSurfacesDoNot) {
  EXPECT_FALSE(crosses_itself(tube(20, 40, [](double z, double) { return 3 + std::sin(z); })));
  EXPECT_FALSE(crosses_itself(TriangleMesh{}));
}

TEST(SelfCrossing, findsAVertexPushedThroughTheOtherSide) {
  TriangleMesh mesh = tube(20, 40, [](double, double) { return 3.0; });
  mesh.vertices[10 * 40 + 3] *= 1.02;
  EXPECT_FALSE(crosses_itself(mesh));
  mesh.vertices[10 * 40 + 3] = Point(-4.0, -0.1, 2.6);
  EXPECT_TRUE(crosses_itself(mesh));
}

TEST(SelfCrossing, agreesWithTheExactTestOnCrumpledTubes) {
  RandomStream random(11);
  int crossing = 0;
  for (int trial = 0; trial < 40; ++trial) {
    const double depth = random.uniform(0.0, 0.35);
    TriangleMesh mesh = tube(16, 30, [](double, double) { return 2.5; });
    for (Point& p : mesh.vertices) p += depth * Eigen::Vector3d(random.normal(), random.normal(), random.normal());
    const bool exact = !self_intersecting_triangles(mesh).empty();
    crossing += exact ? 1 : 0;
    EXPECT_EQ(crosses_itself(mesh), exact) << "trial " << trial;
  }
  EXPECT_GT(crossing, 5);
  EXPECT_LT(crossing, 35);
}

TEST(SkirtRemains, hangOnTheBorderAndLeaveTheCrownAlone) {
  const TriangleMesh crown = tube(12, 48, [](double z, double) { return 3.5 - 0.2 * z; });
  TriangleMesh lid = crown;  // close the upper end: a disc
  const auto top = static_cast<int>(lid.vertices.size());
  lid.vertices.emplace_back(0, 0, 3.2);
  for (int j = 0; j < 48; ++j) lid.triangles.push_back({11 * 48 + j, 11 * 48 + (j + 1) % 48, top});
  ASSERT_EQ(diagnose(lid).euler_number, 1);
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    TriangleMesh skirted = lid;
    RandomStream random(seed);
    add_skirt_remains(skirted, 1.0, random);
    ASSERT_GT(skirted.triangles.size(), lid.triangles.size());
    for (std::size_t i = 0; i < lid.vertices.size(); ++i) EXPECT_EQ(skirted.vertices[i], lid.vertices[i]);
    for (std::size_t i = 0; i < lid.triangles.size(); ++i) EXPECT_EQ(skirted.triangles[i], lid.triangles[i]);
    const Diagnosis diagnosis = diagnose(skirted);
    EXPECT_TRUE(diagnosis.is_oriented_manifold());
    EXPECT_EQ(diagnosis.euler_number, 1);
    EXPECT_EQ(diagnosis.border_loop_count, 1);
    for (const Point& p : skirted.vertices) EXPECT_LT(p.head<2>().norm(), 3.5 + 3.01);
  }
}

}  // namespace
}  // namespace rhizodont
