// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "completion/crown_panorama.hpp"

#include "rhizodont/error.hpp"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <cmath>
#include <numbers>

namespace rhizodont {
namespace {

constexpr double pi = std::numbers::pi;
constexpr std::size_t rows = CrownPanorama::rows, columns = CrownPanorama::columns;

float at(const CrownPanorama& panorama, std::size_t channel, std::size_t row, std::size_t column) {
  return panorama.values.at((channel * rows + row) * columns + column);
}

double elevation(std::size_t row) {
  const double low = CrownPanorama::lowest_elevation;
  return (low + (static_cast<double>(row) + 0.5) * (90 - low) / static_cast<double>(rows)) * pi / 180;
}

/// A box without a bottom, its walls from the ground up: half widths a and b, height c.
TriangleMesh open_box(double a, double b, double c) {
  TriangleMesh box;
  for (const double z : {0.0, c})
    for (const auto& [x, y] : {std::pair(-a, -b), std::pair(a, -b), std::pair(a, b), std::pair(-a, b)})
      box.vertices.emplace_back(x, y, z);
  for (int i = 0; i < 4; ++i) {
    const int next = (i + 1) % 4;
    box.triangles.push_back({i, next, next + 4});
    box.triangles.push_back({i, next + 4, i + 4});
  }
  box.triangles.push_back({4, 5, 6});
  box.triangles.push_back({4, 6, 7});
  return box;
}

TEST(CrownPanorama, ABoxIsSeenWhereItIs) {
  constexpr double a = 4, b = 3, c = 6;
  const CrownPanorama panorama = crown_panorama(open_box(a, b, c), Eigen::Vector3d::UnitZ(), Point::Zero());
  const Eigen::Vector3d x = Eigen::Vector3d::UnitZ().unitOrthogonal(), y = Eigen::Vector3d::UnitZ().cross(x);
  for (std::size_t row = 0; row < rows; ++row)
    for (std::size_t column = 0; column < columns; ++column) {
      const double azimuth = (static_cast<double>(column) + 0.5) * 2 * pi / static_cast<double>(columns);
      const Eigen::Vector3d ray = std::cos(elevation(row)) * (std::cos(azimuth) * x + std::sin(azimuth) * y) +
                                  std::sin(elevation(row)) * Eigen::Vector3d::UnitZ();
      const Eigen::Vector3d reach(a / std::abs(ray.x()), b / std::abs(ray.y()), c / std::abs(ray.z()));
      Eigen::Index side = 0;
      const double distance = reach.minCoeff(&side);
      if (distance * ray.z() < -1e-9) {  // below the ground there is nothing
        for (std::size_t channel = 0; channel < CrownPanorama::channels; ++channel)
          ASSERT_EQ(at(panorama, channel, row, column), 0) << row << " " << column;
        continue;
      }
      ASSERT_EQ(at(panorama, 1, row, column), 1) << row << " " << column;
      EXPECT_NEAR(at(panorama, 0, row, column), distance / 5, 1e-5);
      EXPECT_NEAR(at(panorama, 2, row, column), std::abs(ray[side]), 1e-5);
      const double length =
          std::hypot(at(panorama, 2, row, column), at(panorama, 3, row, column), at(panorama, 4, row, column));
      EXPECT_NEAR(length, 1, 1e-5);
    }
}

TEST(CrownPanorama, TurningShiftsAndMirroringReverses) {
  TriangleMesh box = open_box(4, 3, 6);
  for (Point& p : box.vertices) p += Point(0.4, -0.3, 0.1 * p.x());  // no symmetry
  const Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
  const CrownPanorama before = crown_panorama(box, axis, Point::Zero());
  TriangleMesh turned = box, mirrored = box;
  const Eigen::Vector3d x = axis.unitOrthogonal();
  for (Point& p : turned.vertices) p = Eigen::AngleAxisd(2 * pi / columns, axis) * p;
  for (Point& p : mirrored.vertices) p -= 2 * axis.cross(x).dot(p) * axis.cross(x);
  for (Triangle& t : mirrored.triangles) std::swap(t[1], t[2]);
  const CrownPanorama shifted = crown_panorama(turned, axis, Point::Zero());
  const CrownPanorama reversed = crown_panorama(mirrored, axis, Point::Zero());
  for (std::size_t channel = 0; channel < CrownPanorama::channels; ++channel)
    for (std::size_t row = 0; row < rows; ++row)
      for (std::size_t column = 0; column < columns; ++column) {
        const float here = at(before, channel, row, column);
        ASSERT_NEAR(at(shifted, channel, row, (column + 1) % columns), here, 1e-4) << channel << row << column;
        const float sign = channel == 3 ? -1.0F : 1.0F;
        ASSERT_NEAR(at(reversed, channel, row, columns - 1 - column), sign * here, 1e-4) << channel << row << column;
      }
}

TEST(CrownPanorama, TheOutermostSurfaceIsSeen) {
  TriangleMesh boxes = open_box(4, 3, 6);
  const TriangleMesh inner = open_box(2, 1, 3);
  for (const Triangle& t : inner.triangles) boxes.triangles.push_back({t[0] + 8, t[1] + 8, t[2] + 8});
  boxes.vertices.insert(boxes.vertices.end(), inner.vertices.begin(), inner.vertices.end());
  EXPECT_EQ(crown_panorama(boxes, Eigen::Vector3d::UnitZ(), Point::Zero()).values,
            crown_panorama(open_box(4, 3, 6), Eigen::Vector3d::UnitZ(), Point::Zero()).values);
}

TEST(CrownPanorama, StandsAmidTheBase) {
  const Point shift(7, -2, 11);
  TriangleMesh box = open_box(4, 3, 6);
  for (Point& p : box.vertices) p += shift;
  EXPECT_LT((panorama_centre(box, Eigen::Vector3d::UnitZ()) - shift).norm(), 1e-9);
  box.triangles.push_back({0, 2, 1});
  box.triangles.push_back({0, 3, 2});
  EXPECT_THROW(panorama_centre(box, Eigen::Vector3d::UnitZ()), InputError);
}

}  // namespace
}  // namespace rhizodont
