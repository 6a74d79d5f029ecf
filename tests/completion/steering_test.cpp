// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "completion/steering.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "rhizodont/error.hpp"

namespace rhizodont {
namespace {

constexpr double length = 14;

/// Points of a tube of radius 3 from z = 6 down to -14, its middle at x = y = 0.
std::vector<Point> tube() {
  std::vector<Point> points;
  for (int row = 0; row <= 100; ++row)
    for (int i = 0; i < 16; ++i) {
      const double angle = std::numbers::pi * i / 8;
      points.emplace_back(3 * std::cos(angle), 3 * std::sin(angle), 6 - 0.2 * row);
    }
  return points;
}

/// Its upper part, open below at z = 0.
TriangleMesh crown() {
  TriangleMesh mesh;
  for (int i = 0; i < 16; ++i)
    mesh.vertices.emplace_back(3 * std::cos(std::numbers::pi * i / 8), 3 * std::sin(std::numbers::pi * i / 8), 0);
  mesh.vertices.emplace_back(0, 0, 6);
  for (int i = 0; i < 16; ++i) mesh.triangles.push_back({i, (i + 1) % 16, 16});
  return mesh;
}

double lowest(const std::vector<Point>& points) {
  return std::min_element(points.begin(), points.end(), [](const Point& a, const Point& b) { return a.z() < b.z(); })
      ->z();
}

Point mean_of_last_row(const std::vector<Point>& points) {
  Point mean = Point::Zero();
  for (std::size_t i = points.size() - 16; i < points.size(); ++i) mean += points[i] / 16;
  return mean;
}

TEST(SteerRoot, NothingAskedForNothingDone) {
  std::vector<Point> points = tube();
  steer_root(points, crown(), {}, 36, {});
  EXPECT_EQ(points, tube());
}

TEST(SteerRoot, LengthIsExactAndTheCrownStays) {
  for (const double wanted : {8.0, 13.9, 17.0, 22.0}) {
    std::vector<Point> points = tube();
    RootSteering steering;
    steering.length_mm = wanted;
    steer_root(points, crown(), {}, 36, steering);
    EXPECT_NEAR(lowest(points), -wanted, 1e-9);
    const std::vector<Point> before = tube();
    double last = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (before[i].z() >= 0) {
        EXPECT_EQ(points[i], before[i]);
      }
      if (i % 16 != 0) continue;
      EXPECT_LT(points[i].z(), last);  // no level overtakes another
      last = points[i].z();
    }
  }
}

TEST(SteerRoot, LengthHoldsAfterTurningAndBending) {
  RootSteering steering;
  steering.length_mm = 12.5;
  steering.tip_degrees = 12;
  steering.torque_degrees = -8;
  steering.bend_degrees = 30;
  std::vector<Point> points = tube();
  steer_root(points, crown(), {}, 24, steering);
  EXPECT_NEAR(lowest(points), -12.5, 1e-9);
}

TEST(SteerRoot, TurnsTheWayItSays) {
  // frame: +x is distal for upper, mesial for lower teeth; +y towards the cheek
  RootSteering tip, torque;
  tip.tip_degrees = torque.torque_degrees = 10;
  for (const int fdi : {26, 36}) {
    std::vector<Point> tipped = tube(), torqued = tube();
    steer_root(tipped, crown(), {}, fdi, tip);
    steer_root(torqued, crown(), {}, fdi, torque);
    const Point t = mean_of_last_row(tipped), q = mean_of_last_row(torqued);
    EXPECT_GT(fdi == 26 ? t.x() : -t.x(), 1.5);
    EXPECT_NEAR(t.y(), 0, 1e-9);
    EXPECT_LT(q.y(), -1.5);
    EXPECT_NEAR(q.x(), 0, 1e-9);
  }
  CanonicalFrame right;
  right.mirrored = true;
  std::vector<Point> points = tube();
  steer_root(points, crown(), right, 16, tip);
  EXPECT_LT(mean_of_last_row(points).x(), -1.5);
}

TEST(SteerRoot, CrossSectionsKeepTheirShape) {
  RootSteering steering;
  steering.tip_degrees = 20;
  steering.bend_degrees = 25;
  std::vector<Point> points = tube();
  steer_root(points, crown(), {}, 36, steering);
  const Point middle = mean_of_last_row(points);
  for (std::size_t i = points.size() - 16; i < points.size(); ++i) EXPECT_NEAR((points[i] - middle).norm(), 3, 1e-9);
  // the last section stands across a direction 45 degrees from the axis
  const Eigen::Vector3d normal =
      (points[points.size() - 16] - middle).cross(points[points.size() - 12] - middle).normalized();
  EXPECT_NEAR(std::abs(normal.z()), std::cos(std::numbers::pi / 4), 1e-6);
}

TEST(SteerRoot, LeavesTheCrownWithoutAKink) {
  RootSteering steering;
  steering.torque_degrees = 25;
  steering.length_mm = 20;
  std::vector<Point> near{{3, 0, -1e-3}, {0, 3, -1e-3}, {0, 0, -length}};
  const std::vector<Point> before = near;
  steer_root(near, crown(), {}, 36, steering);
  EXPECT_LT((near[0] - before[0]).norm(), 1e-5);
  EXPECT_LT((near[1] - before[1]).norm(), 1e-5);
}

TEST(SteerRoot, RefusesWhatIsOutOfRange) {
  const auto throws_usage = [](auto set) {
    RootSteering steering;
    set(steering);
    std::vector<Point> points = tube();
    EXPECT_THROW(steer_root(points, crown(), {}, 36, steering), UsageError);
  };
  throws_usage([](RootSteering& s) { s.length_mm = 2; });
  throws_usage([](RootSteering& s) { s.length_mm = std::nan(""); });
  throws_usage([](RootSteering& s) { s.tip_degrees = 31; });
  throws_usage([](RootSteering& s) { s.torque_degrees = std::nan(""); });
  throws_usage([](RootSteering& s) { s.bend_degrees = -46; });
  std::vector<Point> above{{0, 0, 3}};
  RootSteering tip;
  tip.tip_degrees = 5;
  EXPECT_THROW(steer_root(above, crown(), {}, 36, tip), NoResultError);
}

}  // namespace
}  // namespace rhizodont
