// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "poisson/iterative_poisson.hpp"

#include <gtest/gtest.h>

#include "common/option_faults.hpp"
#include "mesh/diagnosis.hpp"
#include "mesh/geometry.hpp"
#include "poisson/shapes.hpp"

#include <numbers>
#include <random>
#include <vector>

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

TEST(IterativePoisson, RefusesOptionsOutOfRange) {
  std::vector<test::Fault> faults;
  using P = IterativePoissonOptions;
  test::Faults<P>(faults, [](const P& o) { iterative_poisson({}, o); })
      .of("e", &P::e, {0.0})
      .of("neighbours", &P::neighbours, {0})
      .of("most_iterations", &P::most_iterations, {0})
      .of("still", &P::still, {0.0})
      .set("degree", [](P& o) { o.indicator.degree = 3; });
  test::expect_each_refused_by_name(faults);
}

}  // namespace
}  // namespace rhizodont
