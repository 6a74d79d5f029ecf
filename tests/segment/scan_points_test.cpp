// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "segment/scan_points.hpp"

#include "base/float_bits.hpp"
#include "mesh/adjacency.hpp"
#include "mesh/append_mesh.hpp"
#include "networks/cloud_grid.hpp"
#include "rhizodont/error.hpp"
#include "segment/sheet.hpp"

#include <Eigen/Geometry>

#include <gtest/gtest.h>

#include <cmath>

namespace rhizodont {
namespace {

/// 30 mm x 20 mm of hills; with a flat base around them all if `closed`.
TriangleMesh hills(bool closed) {
  const auto surface = [](double height_of_hills, double depth) {
    return test::sheet(61, 41, [&](double s, double t) {
      const double x = 30 * s, y = 20 * t;
      const bool rim = s == 0 || t == 0 || s == 1 || t == 1;
      const double z = rim ? 0 : height_of_hills * (2 + std::sin(0.9 * x + 0.2) * std::cos(0.7 * y)) - depth;
      return Point(x, y + 0.01 * x * x, z);
    });
  };
  TriangleMesh mesh = surface(1.5, 0);
  if (closed) append_mesh(mesh, flipped(surface(0, 6)));
  return mesh;
}

/// Of points that are where no point of the others is.
double share_without_fellow(const ScanLevel& level, const ScanLevel& others) {
  const std::vector<std::int32_t> nearest = CloudGrid(others.positions, 1).nearest(level.positions, 1);
  int without = 0;
  for (std::size_t i = 0; i < level.size(); ++i)
    for (std::size_t a = 0; a < 3; ++a)
      if (std::abs(level.positions[3 * i + a] - others.positions[3 * static_cast<std::size_t>(nearest[i]) + a]) >
          1e-3F) {
        ++without;
        break;
      }
  return without / static_cast<double>(level.size());
}

TEST(ScanPoints, TheSameOnesInAnyPose) {
  for (const bool closed : {false, true}) {
    SCOPED_TRACE(closed);
    const TriangleMesh scan = hills(closed);
    const ScanFrame frame = first_frame(scan);
    const ScanPyramid pyramid = scan_pyramid(scan_points(scan, frame).cloud, {});
    for (int pose = 1; pose < 5; ++pose) {
      const Eigen::Matrix3d rotation =
          Eigen::AngleAxisd(1.3 * pose, Eigen::Vector3d(1, -0.4 * pose, 0.7).normalized()).toRotationMatrix();
      TriangleMesh moved = scan;
      for (Point& p : moved.vertices) p = nearest_float(rotation * p + Point(120, -70, 30 * pose));
      const ScanFrame again = first_frame(moved);
      EXPECT_LT((again.rotation * rotation - frame.rotation).norm(), 1e-4);
      const ScanPyramid its = scan_pyramid(scan_points(moved, again).cloud, {});
      for (std::size_t l = 0; l < ScanShape::levels; ++l)
        EXPECT_LT(share_without_fellow(its.levels[l], pyramid.levels[l]), 0.005) << "level " << l;
    }
  }
}

TEST(ScanPoints, TurnedOnesAreThoseOfATurnedFrame) {
  const TriangleMesh scan = hills(false);
  ScanFrame frame = first_frame(scan);
  ScanCloud cloud = scan_points(scan, frame).cloud;
  move_origin_to_mean(frame, cloud);
  ScanPyramid pyramid = scan_pyramid(cloud, {});
  const Eigen::Matrix3d rotation = Eigen::AngleAxisd(0.7, Eigen::Vector3d(0.3, 1, 2).normalized()).toRotationMatrix();
  turn(rotation, pyramid);
  ScanCloud turned = cloud;
  turn(rotation, turned);
  for (std::size_t l = 1; l < ScanShape::levels; ++l)
    for (std::size_t i = 0; i < pyramid.levels[l].size(); ++i)
      for (std::size_t k = 0; k < 3; ++k)
        ASSERT_EQ(pyramid.levels[l].positions[3 * i + k],
                  pyramid.levels[l - 1].positions[3 * static_cast<std::size_t>(pyramid.levels[l].from[i]) + k]);
  for (std::size_t i = 0; i < pyramid.levels[0].size(); ++i) {
    const auto p = 3 * static_cast<std::size_t>(pyramid.levels[0].from[i]);
    for (Eigen::Index a = 0; a < 3; ++a) {
      const auto k = static_cast<std::size_t>(a);
      const Eigen::Vector3f place(cloud.positions[p], cloud.positions[p + 1], cloud.positions[p + 2]);
      const double is = (rotation * place.cast<double>())[a];
      EXPECT_NEAR(static_cast<double>(pyramid.levels[0].positions[3 * i + k]), is, 1e-4);
      EXPECT_NEAR(static_cast<double>(pyramid.features[scan_feature_count * i + k]), is / 25, 1e-5);
      EXPECT_EQ(turned.positions[p + k], pyramid.levels[0].positions[3 * i + k]);
      const Eigen::Vector3f normal(cloud.normals[p], cloud.normals[p + 1], cloud.normals[p + 2]);
      EXPECT_NEAR(static_cast<double>(turned.normals[p + k]), (rotation * normal.cast<double>())[a], 1e-5);
      EXPECT_EQ(pyramid.levels[0].normals[3 * i + k], turned.normals[p + k]);
      EXPECT_EQ(pyramid.features[scan_feature_count * i + 3 + k], turned.normals[p + k]);
    }
  }
}

TEST(ScanPoints, ASheetThatFacesBothWaysIsRefused) {
  TriangleMesh scan = hills(false);
  const TriangleMesh once = scan;
  const auto first = static_cast<std::int32_t>(once.vertices.size());
  scan.vertices.insert(scan.vertices.end(), once.vertices.begin(), once.vertices.end());
  for (const Triangle& t : once.triangles) scan.triangles.push_back({first + t[0], first + t[2], first + t[1]});
  EXPECT_THROW(scan_points(scan, {}), InputError);
}

}  // namespace
}  // namespace rhizodont
