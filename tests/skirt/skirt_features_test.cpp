// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "skirt/skirt_features.hpp"

#include "mesh/diagnosis.hpp"
#include "mesh/geometry.hpp"
#include "operators/surfaces.hpp"
#include "rhizodont/error.hpp"
#include "skirt/skirt_network.hpp"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

namespace rhizodont {
namespace {

/// The bowl turned over, 8 mm wide: an open crown whose axis is near z.
TriangleMesh small_crown(int size) {
  TriangleMesh mesh = test::bowl(size);
  for (Point& p : mesh.vertices) p = Point(7 * p.x(), 6 * p.y(), -9 * p.z());
  return mesh;
}

float feature(const SurfaceSample& sample, int vertex, int which) {
  return sample.features[static_cast<std::size_t>(vertex * surface_feature_count + which)];
}

TEST(SkirtFeatures, DoNotDependOnThePose) {
  const TriangleMesh mesh = small_crown(16);
  TriangleMesh moved = mesh;
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(2.1, Eigen::Vector3d(1, -3, 2).normalized()).toRotationMatrix();
  for (Point& p : moved.vertices) p = turn * p + Point(40, -7, 12);
  const SurfaceSample a = skirt_features(mesh, 20), b = skirt_features(moved, 20);
  check_surface_sample(a, false);
  for (int v = 0; v < a.vertices; ++v) {
    // The turn about z is free: heights and distances from the axis are the same.
    for (const int at : {SurfaceFeature::position, SurfaceFeature::normal}) {
      EXPECT_NEAR(std::hypot(feature(a, v, at), feature(a, v, at + 1)),
                  std::hypot(feature(b, v, at), feature(b, v, at + 1)), 1e-4);
      EXPECT_NEAR(feature(a, v, at + 2), feature(b, v, at + 2), 1e-4);
    }
    for (int c = SurfaceFeature::border; c < surface_feature_count; ++c)
      EXPECT_NEAR(feature(a, v, c), feature(b, v, c), 2e-3) << c;
  }
}

TEST(SkirtFeatures, BorderIsWhereItsFeatureIsOne) {
  const SurfaceSample sample = skirt_features(small_crown(12), 16);
  for (int v = 0; v < sample.vertices; ++v) {
    const bool border = v % 13 == 0 || v % 13 == 12 || v < 13 || v >= 156;
    EXPECT_EQ(feature(sample, v, SurfaceFeature::border) == 1, border);
  }
}

TEST(SkirtFeatures, CurvatureTellsAHollowFromABump) {
  TriangleMesh mesh = small_crown(16);
  const int middle = 8 * 17 + 8;
  EXPECT_GT(feature(skirt_features(mesh, 16), middle, SurfaceFeature::curvature), 0.02);
  for (Point& p : mesh.vertices) p.z() = -p.z();
  EXPECT_LT(feature(skirt_features(mesh, 16), middle, SurfaceFeature::curvature), -0.02);
}

TEST(SkirtFeatures, RefuseClosedAndTinyMeshes) {
  EXPECT_THROW(skirt_features(test::sphere(3), 8), InputError);
  EXPECT_THROW(skirt_features(small_crown(1), 8), InputError);
  EXPECT_EQ(skirt_features(small_crown(6), 48).eigenvectors, 49 / 2 - 8);
}

TEST(Decimated, KeepsShapeAndTopology) {
  const TriangleMesh mesh = small_crown(60);
  const TriangleMesh copy = decimated(mesh, 900);
  EXPECT_NEAR(static_cast<double>(copy.vertices.size()), 900, 60);
  const Diagnosis diagnosis = diagnose(copy);
  EXPECT_TRUE(diagnosis.is_oriented_manifold());
  EXPECT_EQ(diagnosis.euler_number, 1);
  EXPECT_NEAR(surface_area(copy), surface_area(mesh), 0.02 * surface_area(mesh));
  EXPECT_EQ(decimated(mesh, 5000).vertices.size(), mesh.vertices.size());
}

}  // namespace
}  // namespace rhizodont
