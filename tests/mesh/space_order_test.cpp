// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/space_order.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <set>

namespace rhizodont {
namespace {

std::vector<Point> points_of(const std::vector<Point>& points, const std::vector<int>& order) {
  std::vector<Point> result;
  for (const int v : order) result.push_back(points[static_cast<std::size_t>(v)]);
  return result;
}

TEST(SpaceOrder, DoesNotHangOnTheOrderOfPoints) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> within(-7, 7);
  std::vector<Point> points;
  for (int i = 0; i < 500; ++i) points.emplace_back(within(random), within(random), i % 5);
  const std::vector<Point> first = points_of(points, space_order(points, 1e-3));
  std::shuffle(points.begin(), points.end(), random);
  EXPECT_EQ(points_of(points, space_order(points, 1e-3)), first);
}

TEST(SpaceOrder, NeighboursOnTheCurveLieBesideEachOther) {
  std::vector<Point> points;
  for (int x = 0; x < 8; ++x)
    for (int y = 0; y < 8; ++y)
      for (int z = 0; z < 8; ++z) points.emplace_back(x + 0.5, y + 0.5, z + 0.5);
  const std::vector<Point> along = points_of(points, space_order(points, 1));
  double sum = 0;
  for (std::size_t i = 1; i < along.size(); ++i) sum += (along[i] - along[i - 1]).norm();
  EXPECT_LT(sum / 511, 1.6);                         // row by row it would be 2.2
  for (std::size_t i = 0; i < along.size(); i += 8)  // each eight are a cube of two by two by two
    for (std::size_t k = 1; k < 8; ++k) EXPECT_LE((along[i + k] - along[i]).cwiseAbs().maxCoeff(), 1);
}

TEST(SpaceOrder, TakesWhatIsFarOutsideOrNoNumber) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();
  const std::vector<Point> points{{nan, 0, 0}, {1e30, 1e30, 1e30}, {0, 0, 0}, {infinite, 0, 0}, {-1e30, -1e30, -1e30}};
  EXPECT_EQ(space_order(points, 1e-3), (std::vector<int>{4, 2, 1, 0, 3}));
}

TEST(SpaceOrder, AReorderedMeshHasTheSameTriangles) {
  const TriangleMesh mesh{{{3, 0, 0}, {0, 0, 0}, {0, 3, 0}, {0, 0, 3}}, {{0, 2, 1}, {1, 3, 0}, {2, 3, 1}, {3, 2, 0}}};
  const MeshOrder order = space_order(mesh, 1);
  const TriangleMesh again = reordered(mesh, order);
  EXPECT_EQ(again.vertices.front(), Point(0, 0, 0));
  std::set<std::array<int, 3>> expected, found;
  for (const Triangle& t : mesh.triangles) {
    std::array<int, 3> corners{t[0], t[1], t[2]};
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    expected.insert(corners);
  }
  for (const Triangle& t : again.triangles) {
    EXPECT_EQ(t[0], std::min({t[0], t[1], t[2]}));
    std::array<int, 3> corners{};
    for (std::size_t i = 0; i < 3; ++i) corners[i] = order.vertices[static_cast<std::size_t>(t[i])];
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    found.insert(corners);
  }
  EXPECT_EQ(found, expected);
}

}  // namespace
}  // namespace rhizodont
