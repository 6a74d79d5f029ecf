// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/sampling.hpp"

#include "mesh/geometry.hpp"
#include "mesh/test_meshes.hpp"
#include "rhizodont/error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <random>
#include <set>

namespace rhizodont {
namespace {

using test::cube, test::grid, test::sphere;

TEST(SampleSurface, PointsLieOnTheirTriangles) {
  const TriangleMesh mesh = cube();
  const SurfaceSamples samples = sample_surface(mesh, 2000, 3);
  ASSERT_EQ(samples.points.size(), 2000U);
  for (std::size_t k = 0; k < 2000; ++k) {
    const auto t = static_cast<std::size_t>(samples.triangles[k]);
    const Point& corner = mesh.vertices[static_cast<std::size_t>(mesh.triangles[t][0])];
    EXPECT_NEAR((samples.points[k] - corner).dot(samples.normals[k]), 0, 1e-15);
    EXPECT_LT((samples.normals[k] - triangle_normal(mesh, t)).norm(), 1e-15);
    EXPECT_GE(samples.points[k].minCoeff(), -1e-15);
    EXPECT_LE(samples.points[k].maxCoeff(), 1 + 1e-15);
  }
}

TEST(SampleSurface, UniformOverTheArea) {
  // a unit square and one nine times as large: moments of the uniform distribution on each, shares by area
  TriangleMesh mesh = test::together(grid(1), grid(1), {10, 0, 0});
  for (std::size_t v = 4; v < 8; ++v) mesh.vertices[v] = Point(10, 0, 0) + 3 * (mesh.vertices[v] - Point(10, 0, 0));
  const int count = 40000;
  const SurfaceSamples samples = sample_surface(mesh, count, 5);
  double small = 0, mean = 0, square = 0;
  for (const Point& p : samples.points) {
    if (p.x() < 5) {
      ++small;
      mean += p.x();
      square += p.x() * p.x();
    }
  }
  EXPECT_NEAR(small / count, 0.1, 5 * std::sqrt(0.09 / count));
  EXPECT_NEAR(mean / small, 0.5, 5 * std::sqrt(1.0 / 12 / small));
  EXPECT_NEAR(square / small, 1.0 / 3, 5 * std::sqrt(4.0 / 45 / small));
}

TEST(SampleSurface, SeedDecides) {
  const auto a = sample_surface(cube(), 50, 1), b = sample_surface(cube(), 50, 1), c = sample_surface(cube(), 50, 2);
  EXPECT_EQ(a.points, b.points);
  EXPECT_NE(a.points, c.points);
}

TEST(SampleSurface, NeverOnTrianglesWithoutArea) {
  TriangleMesh mesh = grid(1);
  mesh.triangles = {{0, 0, 1}, mesh.triangles[0], mesh.triangles[1], {2, 2, 1}};
  for (const int t : sample_surface(mesh, 500, 1).triangles) EXPECT_TRUE(t == 1 || t == 2);
}

TEST(SampleSurface, RefusesMeshWithoutArea) {
  EXPECT_THROW(sample_surface({}, 10, 1), InputError);
  EXPECT_THROW(sample_surface({{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}}, 10, 1), InputError);
}

TEST(FarthestPointSampling, EachPointIsTheFarthestFromThoseBefore) {
  const std::vector<Point> points = sample_surface(sphere(3), 400, 9).points;
  const std::vector<int> chosen = farthest_point_sampling(points, 60);
  ASSERT_EQ(chosen.size(), 60U);
  const auto gap = [&](std::size_t k, int i) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j < k; ++j)
      least =
          std::min(least, (points[static_cast<std::size_t>(i)] - points[static_cast<std::size_t>(chosen[j])]).norm());
    return least;
  };
  for (std::size_t k = 1; k < chosen.size(); ++k) {
    const double own = gap(k, chosen[k]);
    for (int i = 0; i < 400; ++i) EXPECT_LE(gap(k, i), own + 1e-12);
  }
}

TEST(FarthestPointSampling, OrderOfThePointsDoesNotMatter) {
  // all on a grid: ties everywhere
  std::vector<Point> points = grid(9).vertices;
  const auto reference = farthest_point_sampling(points, 30);
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), 0U);
  std::shuffle(order.begin(), order.end(), std::mt19937(4));
  std::vector<Point> shuffled;
  for (const std::size_t i : order) shuffled.push_back(points[i]);
  const auto again = farthest_point_sampling(shuffled, 30);
  for (std::size_t k = 0; k < reference.size(); ++k)
    EXPECT_EQ(points[static_cast<std::size_t>(reference[k])], shuffled[static_cast<std::size_t>(again[k])]);
}

TEST(FarthestPointSampling, StartsFarthestFromTheCentroidTiesLexicographic) {
  EXPECT_EQ(farthest_point_sampling({{1, 1, 0}, {0, 1, 0}, {1, 0, 0}, {0, 0, 0}}, 2), (std::vector<int>{3, 0}));
}

TEST(FarthestPointSampling, AllPointsAreChosenOnceEvenIfTheyCoincide) {
  const std::vector<Point> points(5, Point(1, 2, 3));
  const auto chosen = farthest_point_sampling(points, 5);
  EXPECT_EQ(std::set<int>(chosen.begin(), chosen.end()).size(), 5U);
}

TEST(FarthestPointSampling, RefusesBadInput) {
  EXPECT_THROW(farthest_point_sampling({{0, 0, 0}}, 2), UsageError);
  EXPECT_THROW(farthest_point_sampling({{0, 0, std::numeric_limits<double>::quiet_NaN()}}, 1), InputError);
  EXPECT_TRUE(farthest_point_sampling({}, 0).empty());
}

}  // namespace
}  // namespace rhizodont
