// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "isosurface/iterative_poisson.hpp"

#include <gtest/gtest.h>

#include "mesh/diagnosis.hpp"
#include "mesh/geometry.hpp"
#include "poisson/shapes.hpp"
#include "rhizodont/error.hpp"

namespace rhizodont {
namespace {

std::size_t wrong_sides(const OrientedPoints& oriented, const OrientedPoints& truth) {
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < truth.points.size(); ++i)
    wrong += oriented.normals[i].dot(truth.normals[i]) <= 0.0 ? 1 : 0;
  return wrong;
}

IterativePoissonOptions coarse() {
  IterativePoissonOptions options;
  options.indicator.spacing = 0.4;
  options.e = 0.8;
  return options;
}

TEST(IterativePoisson, OrientsASphereFromNothing) {
  const OrientedPoints truth = shapes::sphere(800, 4.0);
  const IterativePoisson result = iterative_poisson(truth.points, coarse());
  EXPECT_EQ(result.oriented.points, truth.points);
  EXPECT_EQ(wrong_sides(result.oriented, truth), 0U);
  EXPECT_LT(result.change, coarse().still);
  EXPECT_GT(result.iterations, 1);
  EXPECT_TRUE(diagnose(result.surface).is_closed_solid());
  EXPECT_NEAR(volume(result.surface), 4.0 / 3.0 * std::numbers::pi * 64.0, 10.0);
}

TEST(IterativePoisson, OrientsTwoRoots) {
  std::mt19937 random(2);
  const OrientedPoints truth = shapes::capsules(2500, shapes::two_rooted(), random);
  const IterativePoisson result = iterative_poisson(truth.points, coarse());
  EXPECT_LE(wrong_sides(result.oriented, truth), truth.points.size() / 100);
}

TEST(IterativePoisson, IsTheSameForTheSameSeed) {
  const OrientedPoints truth = shapes::sphere(400, 3.0);
  IterativePoissonOptions options = coarse();
  options.most_iterations = 3;
  EXPECT_EQ(iterative_poisson(truth.points, options).oriented.normals,
            iterative_poisson(truth.points, options).oriented.normals);
}

TEST(IterativePoisson, RefusesBadOptions) {
  IterativePoissonOptions options;
  options.most_iterations = 0;
  EXPECT_THROW(iterative_poisson(shapes::sphere(100, 2.0).points, options), UsageError);
}

TEST(MarchingTetrahedra, HasVerticesOnTheSurfaceAndKeepsAllParts) {
  const ScalarField two_balls = [](const Point& p) {
    FieldSample sample;
    const double a = p.norm(), b = (p - Point(6.0, 0.0, 0.0)).norm();
    sample.value = std::max(1.0 - a, 1.0 - b);
    return sample;
  };
  const std::vector<Point> seeds{Point(1.0, 0.0, 0.0), Point(5.0, 0.0, 0.0)};
  IsosurfaceOptions options;
  options.e = 0.2;
  const double ball = 4.0 / 3.0 * std::numbers::pi;
  const TriangleMesh one = marching_tetrahedra(two_balls, 0.0, seeds, options);
  EXPECT_NEAR(volume(one), ball, 0.05 * ball);
  options.every_component = true;
  const TriangleMesh both = marching_tetrahedra(two_balls, 0.0, seeds, options);
  EXPECT_NEAR(volume(both), 2.0 * ball, 0.1 * ball);
  for (const Point& p : both.vertices) EXPECT_NEAR(two_balls(p).value, 0.0, 1e-6);
}

}  // namespace
}  // namespace rhizodont
