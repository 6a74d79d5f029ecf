// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "poisson/orientation.hpp"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include "poisson/shapes.hpp"
#include "rhizodont/error.hpp"

namespace rhizodont {
namespace {

std::size_t wrong_sides(const OrientedPoints& oriented, const OrientedPoints& truth) {
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < truth.points.size(); ++i)
    if (oriented.normals[i].dot(truth.normals[i]) <= 0.0) ++wrong;
  return wrong;
}

double mean_angle(const OrientedPoints& oriented, const OrientedPoints& truth) {
  double sum = 0.0;
  for (std::size_t i = 0; i < truth.points.size(); ++i)
    sum += std::acos(std::clamp(oriented.normals[i].dot(truth.normals[i]), -1.0, 1.0));
  return sum / static_cast<double>(truth.points.size()) * 180.0 / std::numbers::pi;
}

/// Normals with noise, of which a part is turned over and a part is missing.
std::vector<Eigen::Vector3d> hints_from(const OrientedPoints& truth, double noise, double turned, double missing,
                                        std::mt19937& random) {
  std::normal_distribution<double> normal(0.0, noise);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::vector<Eigen::Vector3d> hints;
  for (const Eigen::Vector3d& n : truth.normals) {
    const Eigen::Vector3d noisy = n + Eigen::Vector3d(normal(random), normal(random), normal(random));
    const double draw = uniform(random);
    hints.push_back(draw < missing ? Eigen::Vector3d(Eigen::Vector3d::Zero())
                                   : Eigen::Vector3d(draw < missing + turned ? -noisy : noisy));
  }
  return hints;
}

TEST(Orientation, OfASphereNeedsNoHints) {
  const OrientedPoints truth = shapes::sphere(800, 4.0, Point(10.0, -3.0, 2.0));
  const OrientedPoints oriented = orient_normals(truth.points);
  EXPECT_EQ(oriented.points, truth.points);
  EXPECT_EQ(wrong_sides(oriented, truth), 0U);
  EXPECT_LT(mean_angle(oriented, truth), 1.0);
  for (const Eigen::Vector3d& n : oriented.normals) EXPECT_NEAR(n.norm(), 1.0, 1e-12);
}

TEST(Orientation, OfATorusOutvotesWrongHints) {
  std::mt19937 random(1);
  const OrientedPoints truth = shapes::torus(3000, 5.0, 1.5, random);
  const auto hints = hints_from(truth, 0.3, 0.15, 0.5, random);
  const OrientedPoints oriented = orient_normals(truth.points, hints);
  EXPECT_EQ(wrong_sides(oriented, truth), 0U);
  EXPECT_LT(mean_angle(oriented, truth), 8.0);
}

TEST(Orientation, TellsTwoRootsApart) {
  std::mt19937 random(2);
  const OrientedPoints truth = shapes::capsules(2500, shapes::two_rooted(), random);
  EXPECT_EQ(wrong_sides(orient_normals(truth.points), truth), 0U);
}

TEST(Orientation, CarriesTheCrownsHintsDownTheRoots) {
  std::mt19937 random(3);
  const OrientedPoints truth = shapes::capsules(2500, shapes::two_rooted(), random);
  std::vector<Eigen::Vector3d> hints = truth.normals;
  for (std::size_t i = 0; i < hints.size(); ++i)
    if (truth.points[i].z() < 0.0) hints[i].setZero();
  EXPECT_EQ(wrong_sides(orient_normals(truth.points, hints), truth), 0U);
}

TEST(Orientation, KeepsTheSidesOfAThinPlateApart) {
  // Samples are as far from each other as the plate is thick; a quarter of the hints is missing or on the wrong side.
  std::mt19937 random(4);
  const OrientedPoints truth = shapes::box(600, {8.0, 6.0, 0.4}, random);
  const auto hints = hints_from(truth, 0.2, 0.05, 0.2, random);
  const OrientedPoints oriented = orient_normals(truth.points, hints);
  EXPECT_LE(wrong_sides(oriented, truth), truth.points.size() / 20);
  std::size_t agreeing_hints = 0;
  for (std::size_t i = 0; i < hints.size(); ++i) agreeing_hints += hints[i].dot(truth.normals[i]) > 0.0 ? 1 : 0;
  EXPECT_GT(truth.points.size() - wrong_sides(oriented, truth), agreeing_hints);
}

TEST(Orientation, TurnsEachPartOutward) {
  OrientedPoints truth = shapes::sphere(400, 2.0);
  const OrientedPoints other = shapes::sphere(400, 2.0, Point(20.0, 0.0, 0.0));
  truth.points.insert(truth.points.end(), other.points.begin(), other.points.end());
  truth.normals.insert(truth.normals.end(), other.normals.begin(), other.normals.end());
  EXPECT_EQ(wrong_sides(orient_normals(truth.points), truth), 0U);
  std::vector<Eigen::Vector3d> inward;
  for (const Eigen::Vector3d& n : truth.normals) inward.push_back(-n);
  EXPECT_EQ(wrong_sides(orient_normals(truth.points, inward), truth), 0U);
  OrientationOptions options;
  options.check_outward = false;
  EXPECT_EQ(wrong_sides(orient_normals(truth.points, inward, options), truth), truth.points.size());
}

TEST(Orientation, TurnsWithTheCloud) {
  std::mt19937 random(5);
  const OrientedPoints truth = shapes::torus(1500, 5.0, 1.5, random);
  const auto hints = hints_from(truth, 0.3, 0.1, 0.3, random);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(1.1, Eigen::Vector3d(1.0, 2.0, -0.5).normalized()).toRotationMatrix();
  std::vector<Point> turned_points;
  std::vector<Eigen::Vector3d> turned_hints;
  for (const Point& p : truth.points) turned_points.push_back(turn * p + Point(1.0, 2.0, 3.0));
  for (const Eigen::Vector3d& hint : hints) turned_hints.push_back(turn * hint);
  const OrientedPoints plain = orient_normals(truth.points, hints),
                       turned = orient_normals(turned_points, turned_hints);
  for (std::size_t i = 0; i < plain.normals.size(); ++i)
    EXPECT_LT((turn * plain.normals[i] - turned.normals[i]).norm(), 1e-6);
}

TEST(Orientation, DoesNotDependOnTheNumberOfThreads) {
  std::mt19937 random(6);
  const OrientedPoints truth = shapes::torus(2000, 5.0, 1.5, random);
  const auto run = [&](std::size_t threads) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    return orient_normals(truth.points).normals;
  };
  const auto one = run(1);
  EXPECT_EQ(run(2), one);
  EXPECT_EQ(run(4), one);
}

TEST(Orientation, EndsWithUnitNormalsOnDegenerateClouds) {
  std::vector<Point> line, same(12, Point(1.0, 2.0, 3.0));
  for (int i = 0; i < 30; ++i) line.push_back(Point(0.1 * i, 0.0, 0.0));
  for (const auto& cloud : {line, same})
    for (const Eigen::Vector3d& n : orient_normals(cloud).normals) EXPECT_NEAR(n.norm(), 1.0, 1e-12);
}

TEST(Orientation, RefusesBadInput) {
  OrientedPoints samples = shapes::sphere(50, 1.0);
  EXPECT_THROW(orient_normals(std::vector<Point>(3, Point::Zero())), InputError);
  EXPECT_THROW(orient_normals(samples.points, std::vector<Eigen::Vector3d>(3, Point::UnitX())), InputError);
  samples.points[7].y() = std::nan("");
  try {
    orient_normals(samples.points);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.elements(), std::vector<std::int64_t>{7});
  }
  OrientationOptions options;
  options.neighbours = 2;
  EXPECT_THROW(orient_normals(shapes::sphere(50, 1.0).points, {}, options), UsageError);
}

}  // namespace
}  // namespace rhizodont
