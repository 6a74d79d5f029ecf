// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/cut_polygon.hpp"

#include "mesh/geometry.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <cmath>
#include <map>
#include <numbers>
#include <numeric>

namespace rhizodont {
namespace {

std::vector<std::int32_t> count_up(std::size_t n) {
  std::vector<std::int32_t> corners(n);
  std::iota(corners.begin(), corners.end(), 0);
  return corners;
}

/// A star with `n` points: corners alternate between two radii, from an inner one on.
std::vector<Point> star(int n) {
  std::vector<Point> points;
  for (int k = 0; k < 2 * n; ++k) {
    const double angle = std::numbers::pi * k / n, radius = k % 2 == 0 ? 0.3 : 1;
    points.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
  }
  return points;
}

/// The polygon's area comes back, no triangle is turned over, and the border is that of the outline.
void expect_right(const std::vector<Point>& points, const std::vector<std::int32_t>& corners, const CutPolygon& cut,
                  const Eigen::Vector3d& normal) {
  const TriangleMesh mesh{points, cut.triangles};
  EXPECT_EQ(cut.triangles.size() + 2, corners.size());
  std::map<std::pair<int, int>, int> walked;
  Eigen::Vector3d outline = Eigen::Vector3d::Zero(), sum = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const std::int32_t a = corners[k], b = corners[(k + 1) % corners.size()];
    outline += points[static_cast<std::size_t>(a)].cross(points[static_cast<std::size_t>(b)]) / 2;
    ++walked[{a, b}];
  }
  for (std::size_t t = 0; t < cut.triangles.size(); ++t) {
    EXPECT_GT(triangle_area_vector(mesh, t).dot(normal), 0) << t;
    sum += triangle_area_vector(mesh, t);
    for (std::size_t i = 0; i < 3; ++i) --walked[{cut.triangles[t][i], cut.triangles[t][(i + 1) % 3]}];
  }
  EXPECT_LT((sum - outline).norm(), 1e-12 * outline.norm());
  for (const auto& [edge, balance] : walked) EXPECT_EQ(balance, (walked[{edge.second, edge.first}]));
}

TEST(CutPolygon, ConvexPolygonsStayFans) {
  std::vector<Point> points;
  for (int k = 0; k < 12; ++k)
    points.emplace_back(std::cos(std::numbers::pi * k / 6), std::sin(std::numbers::pi * k / 6), 0.05 * (k % 2));
  const CutPolygon cut = cut_polygon(points, count_up(12));
  EXPECT_EQ(cut.cut, PolygonCut::fan);
  for (std::size_t k = 0; k < 10; ++k)
    EXPECT_EQ(cut.triangles[k], (Triangle{0, static_cast<int>(k) + 1, static_cast<int>(k) + 2}));
}

TEST(CutPolygon, CornersOnAStraightEdgeChangeNothing) {
  // rounding to float bends the edge a little inwards or outwards
  const Eigen::Vector3f from(7.1F, -3.3F, 12.7F), to(9.4F, 1.2F, 14.9F), side(6.2F, 4.4F, 11.0F);
  std::vector<Point> points;
  for (int k = 0; k <= 10; ++k) points.emplace_back((from + 0.1F * static_cast<float>(k) * (to - from)).cast<double>());
  points.emplace_back(side.cast<double>());
  EXPECT_EQ(cut_polygon(points, count_up(points.size())).cut, PolygonCut::fan);
}

TEST(CutPolygon, StarsInEveryPlaneAndFromEveryCorner) {
  const std::vector<Point> flat = star(9);
  for (const Eigen::Vector3d& axis : {Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(0, 0, -1), Eigen::Vector3d(1, 0, 0),
                                      Eigen::Vector3d(0, -1, 0), Eigen::Vector3d(1, 2, -3).normalized().eval()})
    for (std::size_t start : {0, 1, 7}) {
      const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), axis);
      std::vector<Point> points;
      for (const Point& p : flat) points.push_back(turn * p);
      std::vector<std::int32_t> corners = count_up(points.size());
      std::rotate(corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(start), corners.end());
      const CutPolygon cut = cut_polygon(points, corners);
      EXPECT_EQ(cut.cut, start == 0 ? cut.cut : PolygonCut::constrained);
      expect_right(points, corners, cut, turn * Eigen::Vector3d::UnitZ());
    }
}

TEST(CutPolygon, ManyCorners) {
  std::vector<Point> points;  // a wavy outline, a little bent
  constexpr int count = 5000;
  for (int k = 0; k < count; ++k) {
    const double angle = 2 * std::numbers::pi * k / count, radius = 1 + 0.2 * std::sin(25 * angle);
    points.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0.1 * std::sin(3 * angle));
  }
  const CutPolygon cut = cut_polygon(points, count_up(points.size()));
  EXPECT_EQ(cut.cut, PolygonCut::constrained);
  expect_right(points, count_up(points.size()), cut, Eigen::Vector3d::UnitZ());
}

TEST(CutPolygon, BentConcavePolygons) {
  std::vector<Point> points = star(6);
  for (Point& p : points) p.z() = 0.1 * p.x() * p.x();
  std::vector<std::int32_t> corners = count_up(points.size());
  std::rotate(corners.begin(), corners.begin() + 1, corners.end());
  const CutPolygon cut = cut_polygon(points, corners);
  EXPECT_EQ(cut.cut, PolygonCut::constrained);
  expect_right(points, corners, cut, Eigen::Vector3d::UnitZ());
}

TEST(CutPolygon, AHoleReachedOverABridgeStaysOpen) {
  const std::vector<Point> points{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0},
                                  {1, 1, 0}, {1, 3, 0}, {3, 3, 0}, {3, 1, 0}};
  const std::vector<std::int32_t> corners{0, 1, 2, 3, 0, 4, 5, 6, 7, 4};
  const CutPolygon cut = cut_polygon(points, corners);
  EXPECT_EQ(cut.cut, PolygonCut::constrained);
  expect_right(points, corners, cut, Eigen::Vector3d::UnitZ());
  EXPECT_NEAR(surface_area({points, cut.triangles}), 12, 1e-12);
}

TEST(CutPolygon, OutlinesThatCutOrTouchThemselvesAreSaid) {
  const std::vector<Point> cutting{{0, 0, 0}, {4, 0, 0}, {1, 2, 0}, {3, 2, 0}, {3, -1, 0}, {0, 4, 0}};
  EXPECT_EQ(cut_polygon(cutting, count_up(6)).cut, PolygonCut::fan_as_it_cuts);
  const std::vector<Point> touching{{1, 3, 0}, {0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {2, 0, 0}, {0, 4, 0}};
  const CutPolygon cut = cut_polygon(touching, count_up(6));
  EXPECT_EQ(cut.cut, PolygonCut::fan_as_it_cuts);
  EXPECT_EQ(cut.triangles.size(), 4U);
}

TEST(CutPolygon, WithoutAreaThereIsNothingToChoose) {
  const std::vector<Point> line{{0, 0, 0}, {1, 1, 1}, {3, 3, 3}, {2, 2, 2}};
  EXPECT_EQ(cut_polygon(line, count_up(4)).cut, PolygonCut::fan);
  const std::vector<Point> one(5, Point(1, 2, 3));
  EXPECT_EQ(cut_polygon(one, count_up(5)).triangles.size(), 3U);
}

TEST(CutPolygon, ACornerTwiceInARowGivesATriangleWithoutArea) {
  const std::vector<Point> points = star(5);
  std::vector<std::int32_t> corners = count_up(points.size());
  std::rotate(corners.begin(), corners.begin() + 1, corners.end());
  corners.insert(corners.begin() + 3, corners[3]);
  const CutPolygon cut = cut_polygon(points, corners);
  EXPECT_EQ(cut.cut, PolygonCut::constrained);
  EXPECT_EQ(cut.triangles.size() + 2, corners.size());
  EXPECT_NEAR(surface_area({points, cut.triangles}), 5 * 0.3 * std::sin(std::numbers::pi / 5), 1e-12);
}

}  // namespace
}  // namespace rhizodont
