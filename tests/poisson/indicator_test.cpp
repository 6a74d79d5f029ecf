// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "poisson/indicator.hpp"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <limits>

#include "poisson/shapes.hpp"
#include "rhizodont/error.hpp"

namespace rhizodont {
namespace {

/// Distance from the centre at which the function passes its iso-value in a direction.
double surface_radius(const IndicatorFunction& chi, const Point& centre, const Eigen::Vector3d& direction,
                      double most) {
  double low = 0.0, high = most;
  for (int step = 0; step < 60; ++step) {
    const double middle = 0.5 * (low + high);
    (chi.value(centre + middle * direction) > chi.iso_value() ? low : high) = middle;
  }
  return low;
}

class IndicatorOfDegree : public testing::TestWithParam<int> {
 protected:
  IndicatorOptions options() const {
    IndicatorOptions result;
    result.degree = GetParam();
    return result;
  }
};

TEST_P(IndicatorOfDegree, IsOneInsideZeroOutsideAndMeetsTheSphere) {
  const Point centre(1.0, 2.0, 3.0);
  const OrientedPoints samples = shapes::sphere(5000, 4.0, centre);
  const IndicatorFunction chi = solve_indicator(samples, {}, options());
  EXPECT_NEAR(chi.value(centre), 1.0, 0.05);
  EXPECT_NEAR(chi.value(centre + Point(0.0, 0.0, 4.9)), 0.0, 0.05);
  EXPECT_NEAR(chi.iso_value(), 0.5, 0.02);
  EXPECT_LE(chi.statistics().relative_residual, 1.01 * options().tolerance);
  EXPECT_LE(chi.statistics().cycles, 6);
  EXPECT_NEAR(chi.statistics().sampled_area, 64.0 * std::numbers::pi, 0.08 * 64.0 * std::numbers::pi);
  for (std::size_t i = 0; i < samples.points.size(); i += 7) {
    EXPECT_NEAR(surface_radius(chi, centre, samples.normals[i], 5.0), 4.0, GetParam() == 1 ? 0.01 : 0.005);
    EXPECT_GT(-chi.gradient(samples.points[i]).normalized().dot(samples.normals[i]), GetParam() == 1 ? 0.985 : 0.997);
  }
}

TEST_P(IndicatorOfDegree, IsSolvedToTheStatedResidualWhichIsFineEnoughByDefault) {
  const OrientedPoints samples = shapes::sphere(5000, 4.0);
  IndicatorOptions exact = options();
  exact.tolerance = 1e-6;
  const IndicatorFunction chi = solve_indicator(samples, {}, options()), solved = solve_indicator(samples, {}, exact);
  EXPECT_LE(solved.statistics().relative_residual, 1.01e-6);
  EXPECT_LE(solved.statistics().cycles, GetParam() == 1 ? 10 : 25);
  for (std::size_t i = 0; i < samples.points.size(); i += 7) {
    const Eigen::Vector3d& n = samples.normals[i];
    EXPECT_NEAR(surface_radius(chi, Point::Zero(), n, 5.0), surface_radius(solved, Point::Zero(), n, 5.0), 1e-3);
  }
}

TEST_P(IndicatorOfDegree, GradientIsTheSlopeOfTheValue) {
  const IndicatorFunction chi = solve_indicator(shapes::sphere(1000, 2.0), {}, options());
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-2.6, 2.6);
  const double step = 1e-6;
  for (int i = 0; i < 300; ++i) {
    const Point p(uniform(random), uniform(random), uniform(random));
    const FieldSample sample = chi.evaluate(p);
    EXPECT_EQ(sample.value, chi.value(p));
    EXPECT_EQ(sample.gradient, chi.gradient(p));
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d to = step * Eigen::Vector3d::Unit(axis);
      EXPECT_NEAR(sample.gradient[axis], (chi.value(p + to) - chi.value(p - to)) / (2.0 * step), 1e-4);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Degrees, IndicatorOfDegree, testing::Values(1, 2));

TEST(Indicator, IsZeroOnAndBeyondTheBox) {
  const IndicatorFunction chi = solve_indicator(shapes::sphere(500, 2.0));
  const Eigen::AlignedBox3d box = chi.box();
  EXPECT_TRUE(box.contains(Point(3.0, 3.0, 3.0)));
  for (const Point& p : {box.min(), box.max(), Point(box.max() + Point(1.0, 0.0, 0.0)), Point(1e300, 0.0, 0.0),
                         Point(std::nan(""), 0.0, 0.0), Point(0.0, std::numeric_limits<double>::infinity(), 0.0)}) {
    const FieldSample sample = chi.evaluate(p);
    EXPECT_NEAR(sample.value, 0.0, 1e-12);
    EXPECT_NEAR(sample.gradient.norm(), 0.0, 1e-9);
  }
}

TEST(Indicator, FollowsTheSamplesWhenTheyMove) {
  std::mt19937 random(2);
  const OrientedPoints samples = shapes::capsules(4000, shapes::two_rooted(), random);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1.0, -1.0, 2.0).normalized()).toRotationMatrix();
  const Eigen::Vector3d shift(12.3, -4.5, 6.7);
  OrientedPoints moved = samples;
  for (Point& p : moved.points) p = turn * p + shift;
  for (Eigen::Vector3d& n : moved.normals) n = turn * n;
  const IndicatorFunction chi = solve_indicator(samples), other = solve_indicator(moved);
  EXPECT_NEAR(chi.iso_value(), other.iso_value(), 0.01);
  for (std::size_t i = 0; i < samples.points.size(); i += 11) {
    const FieldSample here = chi.evaluate(samples.points[i]), there = other.evaluate(moved.points[i]);
    const double distance = (here.value - chi.iso_value()) / here.gradient.norm();
    const double other_distance = (there.value - other.iso_value()) / there.gradient.norm();
    EXPECT_NEAR(distance, other_distance, 0.03);
    EXPECT_LT(std::abs(distance), 0.06);
  }
}

TEST(Indicator, KeepsTwoRootsApart) {
  std::mt19937 random(3);
  const IndicatorFunction chi = solve_indicator(shapes::capsules(4000, shapes::two_rooted(), random));
  EXPECT_GT(chi.value(Point(-2.4, 0.0, -7.0)), 0.8);
  EXPECT_GT(chi.value(Point(2.4, 0.0, -7.0)), 0.8);
  EXPECT_LT(chi.value(Point(0.0, 0.0, -7.0)), 0.2);
}

TEST(Indicator, JoinsSparseAndDenseSamples) {
  // 0.17 mm apart above, 0.8 mm below, as scanned and predicted points are.
  OrientedPoints samples;
  for (const auto& [count, upper] : {std::pair{7000, true}, std::pair{320, false}}) {
    const OrientedPoints all = shapes::sphere(static_cast<std::size_t>(count), 4.0);
    for (std::size_t i = 0; i < all.points.size(); ++i)
      if ((all.points[i].z() > 0.0) == upper) {
        samples.points.push_back(all.points[i]);
        samples.normals.push_back(all.normals[i]);
      }
  }
  const IndicatorFunction chi = solve_indicator(samples);
  EXPECT_NEAR(chi.value(Point::Zero()), 1.0, 0.1);
  for (const Eigen::Vector3d& n : shapes::sphere(400, 1.0).normals)
    EXPECT_NEAR(surface_radius(chi, Point::Zero(), n, 5.0), 4.0, n.z() > 0.3 ? 0.01 : 0.06);
}

TEST(Indicator, PassesNearerToSamplesOfMoreWeight) {
  OrientedPoints samples = shapes::sphere(1500, 4.0);
  const OrientedPoints outer = shapes::sphere(1500, 4.15);
  samples.points.insert(samples.points.end(), outer.points.begin(), outer.points.end());
  samples.normals.insert(samples.normals.end(), outer.normals.begin(), outer.normals.end());
  const auto radius_with = [&](double inner_weight, double outer_weight) {
    std::vector<double> weights(3000, inner_weight);
    std::fill(weights.begin() + 1500, weights.end(), outer_weight);
    double sum = 0.0;
    const IndicatorFunction chi = solve_indicator(samples, weights);
    for (const Eigen::Vector3d& n : shapes::sphere(100, 1.0).normals) sum += surface_radius(chi, Point::Zero(), n, 5.0);
    return sum / 100.0;
  };
  EXPECT_NEAR(radius_with(1.0, 0.02), 4.0, 0.02);
  EXPECT_NEAR(radius_with(0.02, 1.0), 4.15, 0.02);
  EXPECT_NEAR(radius_with(1.0, 1.0), 4.075, 0.02);
}

TEST(Indicator, WeightsOfOneAreNoWeights) {
  const OrientedPoints samples = shapes::sphere(800, 2.0);
  const IndicatorFunction plain = solve_indicator(samples),
                          weighted = solve_indicator(samples, std::vector<double>(800, 1.0));
  for (const Point& p : shapes::sphere(50, 1.9).points) EXPECT_EQ(plain.value(p), weighted.value(p));
}

TEST(Indicator, DoesNotDependOnTheLengthOfNormals) {
  const OrientedPoints samples = shapes::sphere(800, 2.0);
  OrientedPoints longer = samples;
  for (Eigen::Vector3d& n : longer.normals) n *= 4.0;
  const IndicatorFunction a = solve_indicator(samples), b = solve_indicator(longer);
  for (const Point& p : shapes::sphere(50, 1.9).points) EXPECT_NEAR(a.value(p), b.value(p), 1e-9);
}

TEST(Indicator, IsTheSameForAnyNumberOfThreads) {
  std::mt19937 random(4);
  const OrientedPoints samples = shapes::capsules(3000, shapes::two_rooted(), random);
  const auto run = [&](std::size_t threads) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    const IndicatorFunction chi = solve_indicator(samples);
    std::vector<double> values{chi.iso_value()};
    for (const Point& p : samples.points) values.push_back(chi.value(1.01 * p));
    return values;
  };
  const std::vector<double> one = run(1);
  EXPECT_EQ(run(2), one);
  EXPECT_EQ(run(4), one);
}

TEST(Indicator, RefusesBadSamplesWithTheirIds) {
  const OrientedPoints good = shapes::sphere(100, 2.0);
  const auto refused = [](const OrientedPoints& samples, std::span<const double> weights = {}) {
    try {
      solve_indicator(samples, weights);
    } catch (const InputError& error) {
      return error.elements();
    }
    return std::vector<std::int64_t>{-1};
  };
  OrientedPoints bad = good;
  bad.points[3].x() = std::nan("");
  EXPECT_EQ(refused(bad), std::vector<std::int64_t>{3});
  bad = good;
  bad.normals[4].setZero();
  bad.normals[9].z() = std::numeric_limits<double>::infinity();
  EXPECT_EQ(refused(bad), (std::vector<std::int64_t>{4, 9}));
  std::vector<double> weights(100, 1.0);
  weights[5] = -1.0;
  EXPECT_EQ(refused(good, weights), std::vector<std::int64_t>{5});
  EXPECT_THROW(solve_indicator(good, std::vector<double>(99, 1.0)), InputError);
  EXPECT_THROW(solve_indicator(shapes::sphere(9, 2.0)), InputError);
  bad = good;
  bad.normals.pop_back();
  EXPECT_THROW(solve_indicator(bad), InputError);
  bad = good;
  for (Point& p : bad.points) p = Point(1.0, 2.0, 3.0);
  EXPECT_THROW(solve_indicator(bad), InputError);
}

TEST(Indicator, RefusesBadOptions) {
  OrientedPoints samples = shapes::sphere(100, 2.0);
  IndicatorOptions options;
  options.degree = 3;
  EXPECT_THROW(solve_indicator(samples, {}, options), UsageError);
  options = {};
  options.spacing = 0.0;
  EXPECT_THROW(solve_indicator(samples, {}, options), UsageError);
  samples.points[0] = Point(1e6, 0.0, 0.0);
  EXPECT_THROW(solve_indicator(samples), UsageError);
  options = {};
  options.max_cycles = 1;
  options.tolerance = 1e-12;
  EXPECT_THROW(solve_indicator(shapes::sphere(500, 2.0), {}, options), NoResultError);
}

}  // namespace
}  // namespace rhizodont
