// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/closest_point.hpp"
#include "mesh/nearest_vertex.hpp"
#include "mesh/test_meshes.hpp"
#include "rhizodont/error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

namespace rhizodont {
namespace {

using test::cube, test::sphere;

Point random_point(std::mt19937& engine, double size) {
  std::uniform_real_distribution<double> number(-size, size);
  return {number(engine), number(engine), number(engine)};
}

TEST(ClosestPointIndexTest, CubeByFormula) {
  const ClosestPointIndex index(cube());
  std::mt19937 engine(1);
  for (int k = 0; k < 500; ++k) {
    const Point q = Point(0.5, 0.5, 0.5) + random_point(engine, 2);
    const Point clamped = q.cwiseMax(0).cwiseMin(1);
    const bool inside = clamped == q;
    const double expected = inside ? std::min(q.minCoeff(), (Point(1, 1, 1) - q).minCoeff()) : (q - clamped).norm();
    const ClosestPoint found = index.closest(q);
    EXPECT_NEAR(found.distance, expected, 1e-12);
    EXPECT_NEAR((found.point - q).norm(), expected, 1e-12);
  }
}

TEST(ClosestPointIndexTest, ZeroAtVerticesAndNamesATriangleThere) {
  const TriangleMesh mesh = sphere(3);
  const ClosestPointIndex index(mesh);
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const ClosestPoint found = index.closest(mesh.vertices[v]);
    EXPECT_EQ(found.distance, 0);
    const Triangle& t = mesh.triangles[static_cast<std::size_t>(found.triangle)];
    EXPECT_NE(std::find(t.begin(), t.end(), static_cast<int>(v)), t.end());
  }
}

TEST(ClosestPointIndexTest, LeavesOutTrianglesWithoutArea) {
  TriangleMesh mesh = cube();
  mesh.vertices.emplace_back(5, 5, 5);
  mesh.triangles.insert(mesh.triangles.begin(), {8, 8, 8});
  const ClosestPoint found = ClosestPointIndex(mesh).closest({0.5, 0.5, 3});
  EXPECT_NEAR(found.distance, 2, 1e-15);
  EXPECT_TRUE(found.triangle == 3 || found.triangle == 4) << found.triangle;
}

TEST(ClosestPointIndexTest, RefusesBadMeshes) {
  EXPECT_THROW(ClosestPointIndex({}), InputError);
  EXPECT_THROW(ClosestPointIndex({{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}}), InputError);
  TriangleMesh mesh = cube();
  mesh.vertices[3].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(ClosestPointIndex{mesh}, InputError);
  mesh = cube();
  mesh.triangles[0][0] = 8;
  EXPECT_THROW(ClosestPointIndex{mesh}, InputError);
}

std::vector<NearVertex> by_hand(const std::vector<Point>& points, const Point& q) {
  std::vector<NearVertex> all;
  for (std::size_t i = 0; i < points.size(); ++i) all.push_back({static_cast<int>(i), (points[i] - q).squaredNorm()});
  std::stable_sort(all.begin(), all.end(),
                   [](const auto& a, const auto& b) { return a.squared_distance < b.squared_distance; });
  return all;
}

TEST(NearestVertexIndexTest, AgreesWithExhaustiveSearch) {
  std::mt19937 engine(2);
  std::vector<Point> points;
  for (int k = 0; k < 700; ++k) points.push_back(random_point(engine, 1));
  const NearestVertexIndex index(points);
  for (int k = 0; k < 50; ++k) {
    const Point q = random_point(engine, 1.5);
    const auto expected = by_hand(points, q);
    const auto found = index.nearest(q, 9);
    ASSERT_EQ(found.size(), 9U);
    for (std::size_t i = 0; i < 9; ++i) EXPECT_EQ(found[i].index, expected[i].index);
    EXPECT_EQ(index.nearest(q).index, expected[0].index);
    const auto ball = index.within(q, 0.6);
    const auto inside =
        std::count_if(expected.begin(), expected.end(), [](auto& n) { return n.squared_distance <= 0.36; });
    ASSERT_EQ(static_cast<std::ptrdiff_t>(ball.size()), inside);
    for (std::size_t i = 0; i < ball.size(); ++i) EXPECT_EQ(ball[i].index, expected[i].index);
  }
}

TEST(NearestVertexIndexTest, LongListsAgreeWithExhaustiveSearch) {
  // points on a sphere, half of them on a small part of it, and a few far away
  std::mt19937 engine(3);
  std::vector<Point> points;
  for (int k = 0; k < 6000; ++k)
    points.push_back((random_point(engine, 1) + Point(k % 2 == 0 ? 0 : 30, 0, 0)).normalized());
  for (int k = 0; k < 5; ++k) points.push_back(random_point(engine, 100));
  const NearestVertexIndex index(points);
  for (int k = 0; k < 20; ++k) {
    const Point q = k % 2 == 0 ? points[static_cast<std::size_t>(k)] : random_point(engine, 3);
    const auto expected = by_hand(points, q);
    for (const std::size_t count : {256U, 257U, 700U, 3500U}) {
      const auto found = index.nearest(q, count);
      ASSERT_EQ(found.size(), count);
      for (std::size_t i = 0; i < count; ++i) ASSERT_EQ(found[i].index, expected[i].index);
    }
  }
}

TEST(NearestVertexIndexTest, TiesGoToTheLowerIndex) {
  // a grid point repeated many times, and the eight corners of a cube about the query
  std::vector<Point> points(40, Point(1, 1, 1));
  for (const Point& p : cube().vertices) points.push_back(2 * p - Point(1, 1, 1));
  const NearestVertexIndex index(points);
  EXPECT_EQ(index.nearest({1.1, 1, 1}).index, 0);
  const auto found = index.nearest({0, 0, 0}, 44);
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_EQ(found[i].index, static_cast<int>(i));
  EXPECT_EQ(index.within({0, 0, 0}, std::sqrt(3) + 1e-12).size(), 48U);
}

TEST(NearestVertexIndexTest, TheRadiusItselfCounts) {
  const NearestVertexIndex index({{0, 0, 0}, {3, 0, 0}, {0, 4, 0}});
  EXPECT_EQ(index.within({0, 0, 0}, 3).size(), 2U);
  EXPECT_EQ(index.within({0, 0, 0}, 0).size(), 1U);
  EXPECT_TRUE(index.within({10, 0, 0}, 1).empty());
}

TEST(NearestVertexIndexTest, FewerPointsThanAskedFor) {
  EXPECT_EQ(NearestVertexIndex({{0, 0, 0}}).nearest({1, 1, 1}, 5).size(), 1U);
}

TEST(NearestVertexIndexTest, RefusesBadInput) {
  EXPECT_THROW(NearestVertexIndex({}), InputError);
  EXPECT_THROW(NearestVertexIndex({{0, 0, std::numeric_limits<double>::infinity()}}), InputError);
  EXPECT_THROW(NearestVertexIndex({{0, 0, 0}}).within({0, 0, 0}, -1), UsageError);
}

}  // namespace
}  // namespace rhizodont
