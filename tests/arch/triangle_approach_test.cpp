// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "arch/triangle_approach.hpp"

#include "arch/exact_distance.hpp"
#include "mesh/closest_on_triangle.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace rhizodont {
namespace {

using test::exact_distance;

double distance_from(const Point& p, const Corners& t) {
  return std::sqrt(closest_on_triangle(p, t[0], t[1], t[2]).squared_distance);
}

void expect_exact(const Corners& a, const Corners& b) {
  const double expected = exact_distance(a, b);
  const TriangleApproach found = nearest_of_triangles(a, b), turned = nearest_of_triangles(b, a);
  EXPECT_NEAR(std::sqrt(found.squared_distance), expected, 1e-13);
  EXPECT_NEAR(std::sqrt(turned.squared_distance), expected, 1e-13);
  EXPECT_EQ(found.squared_distance == 0, expected == 0);
  EXPECT_EQ(triangles_meet(a, b), expected == 0);
  EXPECT_NEAR((found.on_first - found.on_second).norm(), std::sqrt(found.squared_distance), 1e-12);
  EXPECT_LT(distance_from(found.on_first, a), 1e-12);
  EXPECT_LT(distance_from(found.on_second, b), 1e-12);
}

TEST(TriangleApproachTest, AsExactRationalsSay) {
  std::mt19937 engine(1);
  std::uniform_real_distribution<double> place(-1, 1);
  int met = 0;
  for (int k = 0; k < 400; ++k) {
    Corners a, b;
    const Eigen::Vector3d away = 0.02 * (k % 100) * Eigen::Vector3d(place(engine), place(engine), place(engine));
    for (Point& p : a) p = Point(place(engine), place(engine), place(engine));
    for (Point& p : b) p = away + Point(place(engine), place(engine), place(engine));
    met += exact_distance(a, b) == 0;
    expect_exact(a, b);
  }
  EXPECT_GT(met, 20);
  EXPECT_LT(met, 380);
}

TEST(TriangleApproachTest, OnALatticeWhereEdgesAreParallelAndTrianglesTouch) {
  std::mt19937 engine(2);
  std::uniform_int_distribution<int> place(-1, 1);
  int tried = 0;
  while (tried < 600) {
    Corners a, b;
    for (Point& p : a) p = Point(place(engine), place(engine), place(engine));
    for (Point& p : b) p = Point(place(engine), place(engine), place(engine) + tried % 3);
    if (has_no_area(a) || has_no_area(b)) continue;
    expect_exact(a, b);
    ++tried;
  }
}

TEST(TriangleApproachTest, NearlyParallelEdges) {
  // Two blades, edge over edge, crossing at ever smaller angles.
  for (double angle = 1; angle > 1e-12; angle /= 7) {
    const Eigen::Vector3d along(std::cos(angle), std::sin(angle), 0);
    const Corners a{Point(-1, 0, 0), Point(1.1, 0, 0), Point(0, 0.1, -3)};
    for (const double height : {1e-3, 0.5}) {
      const Point middle(0.013, 0, height);
      expect_exact(a, {middle - along, middle + 0.9 * along, middle + Eigen::Vector3d(0, 0.2, 4)});
    }
  }
}

TEST(TriangleApproachTest, CrossingsOfEdges) {
  const Corners t{Point(0, 0, 0), Point(4, 0, 0), Point(0, 4, 0)};
  EXPECT_EQ(crossing_of_edge({1, 1, 3}, {1, 1, -1}, t), 0.75);
  EXPECT_EQ(crossing_of_edge({1, 1, 3}, {1, 1, 0}, t), 1);
  EXPECT_LT(crossing_of_edge({1, 1, 3}, {1, 1, 1e-9}, t), 0);
  EXPECT_LT(crossing_of_edge({3, 3, 3}, {3, 3, -3}, t), 0);
  EXPECT_LT(crossing_of_edge({1, 1, 0}, {2, 1, 0}, t), 0) << "in the plane";
  EXPECT_LT(crossing_of_edge({1, 1, 0}, {1, 1, 0}, t), 0) << "no length";
}

}  // namespace
}  // namespace rhizodont
