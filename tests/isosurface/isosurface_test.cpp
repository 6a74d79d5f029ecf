// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "isosurface/isosurface.hpp"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>

#include "mesh/diagnosis.hpp"
#include "mesh/geometry.hpp"
#include "rhizodont/error.hpp"

namespace rhizodont {
namespace {

/// An ellipsoid around the origin; positive inside, not a distance.
ScalarField ellipsoid(const Eigen::Vector3d& radii) {
  return [radii](const Point& p) {
    const Eigen::Vector3d scaled = p.cwiseQuotient(radii);
    return FieldSample{1.0 - scaled.squaredNorm(), -2.0 * scaled.cwiseQuotient(radii)};
  };
}

ScalarField sphere(double radius) { return ellipsoid(Eigen::Vector3d::Constant(radius)); }

ScalarField torus(double large, double small) {
  return [large, small](const Point& p) {
    const double ring = p.head<2>().norm();
    Eigen::Vector3d gradient(-2.0 * (ring - large) * p.x() / ring, -2.0 * (ring - large) * p.y() / ring, -2.0 * p.z());
    return FieldSample{small * small - (ring - large) * (ring - large) - p.z() * p.z(), gradient};
  };
}

std::vector<double> sorted_angles(const TriangleMesh& mesh) {
  std::vector<double> angles;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const double angle : triangle_angles(mesh, t)) angles.push_back(angle * 180.0 / std::numbers::pi);
  std::ranges::sort(angles);
  return angles;
}

void expect_solid(const Isosurface& surface, int euler_number) {
  const Diagnosis diagnosis = diagnose(surface.mesh);
  EXPECT_TRUE(diagnosis.is_closed_manifold());
  EXPECT_EQ(diagnosis.components, 1);
  EXPECT_EQ(diagnosis.euler_number, euler_number);
  EXPECT_EQ(surface.euler_number, euler_number);
  EXPECT_GT(diagnosis.volume, 0.0);
  EXPECT_TRUE(diagnosis.unreferenced_vertices.empty());
}

IsosurfaceOptions with_e(double e) {
  IsosurfaceOptions options;
  options.e = e;
  options.origin = Point(0.013, -0.021, 0.008);
  return options;
}

TEST(MidNormal, HasTheAnglesOfTheTiling) {
  const std::vector<Point> seeds{Point(2.0, 0.0, 0.0)};
  const Isosurface surface = mid_normal(sphere(2.0), 0.0, seeds, with_e(0.4));
  expect_solid(surface, 2);
  const double low = std::atan(std::sqrt(2.0)) * 180.0 / std::numbers::pi;  // 54.74
  for (const double angle : sorted_angles(surface.mesh)) {
    const double nearest = std::min(
        {std::abs(angle - low), std::abs(angle - (180.0 - 2.0 * low)), std::abs(angle - 45.0), std::abs(angle - 90.0)});
    EXPECT_LT(nearest, 1e-6) << angle;
  }
}

TEST(MidNormal, VerticesSeparateInsideFromOutside) {
  const double e = 0.3;
  const std::vector<Point> seeds{Point(0.0, 0.0, 2.0)};
  const Isosurface surface = mid_normal(sphere(2.0), 0.0, seeds, with_e(e));
  for (const Point& p : surface.mesh.vertices) EXPECT_LE(std::abs(p.norm() - 2.0), 0.5 * std::sqrt(1.5) * e);
}

class GradNormalSphere : public testing::TestWithParam<double> {};

TEST_P(GradNormalSphere, IsASolidOfGoodTrianglesOnTheSurface) {
  const double radius = 2.0, e = GetParam() * radius;
  const std::vector<Point> seeds{Point(2.0, 0.0, 0.0)};
  const Isosurface surface = grad_normal(sphere(radius), 0.0, seeds, with_e(e));
  expect_solid(surface, 2);
  const auto angles = sorted_angles(surface.mesh);
  EXPECT_GT(angles.front(), 35.2);
  EXPECT_LT(angles.back(), 101.55);
  for (const Point& p : surface.mesh.vertices) EXPECT_NEAR(p.norm(), radius, 1e-6);
  EXPECT_EQ(surface.restrained_vertices, 0U);
  // A polyhedron with corners on the sphere lies inside it, by about edge^2 / 8 over the radius.
  EXPECT_NEAR(volume(surface.mesh) / (4.0 / 3.0 * std::numbers::pi * std::pow(radius, 3)), 1.0,
              0.3 * std::pow(e / radius, 2));
  EXPECT_NEAR(static_cast<double>(surface.mesh.vertices.size()) * e * e / (4.0 * std::numbers::pi * radius * radius),
              3.95, 0.2);
}

INSTANTIATE_TEST_SUITE_P(Sizes, GradNormalSphere, testing::Values(0.2, 0.15, 0.1, 0.07, 0.05, 0.03));

/// Without relaxation the range of 35.26 to 101.54 degrees holds in the limit; curvature adds in proportion to e.
TEST(GradNormal, ProjectionAloneComesCloseToTheAngles) {
  const std::vector<Point> seeds{Point(2.0, 0.0, 0.0)};
  for (const double e : {0.4, 0.2, 0.1, 0.05}) {
    IsosurfaceOptions options = with_e(e);
    options.relax = false;
    const Isosurface surface = grad_normal(sphere(2.0), 0.0, seeds, options);
    EXPECT_EQ(surface.relaxed_vertices, 0U);
    const auto angles = sorted_angles(surface.mesh);
    EXPECT_GT(angles.front(), 35.26 - 6.0 * e);
    EXPECT_LT(angles.back(), 101.54 + 7.0 * e);
  }
}

TEST(GradNormal, RelaxationHelpsWhereTheSurfaceBendsWithinTheTiling) {
  const Eigen::Vector3d radii(4.0, 1.5, 0.6);  // radius of curvature at the tip: 0.09
  const std::vector<Point> seeds{Point(4.0, 0.0, 0.0)};
  IsosurfaceOptions options = with_e(0.3);
  const auto relaxed = sorted_angles(grad_normal(ellipsoid(radii), 0.0, seeds, options).mesh);
  options.relax = false;
  const auto plain = sorted_angles(grad_normal(ellipsoid(radii), 0.0, seeds, options).mesh);
  EXPECT_GT(relaxed.front(), plain.front() + 2.0);
  EXPECT_LT(relaxed.back(), plain.back() - 2.0);
}

TEST(GradNormal, MeshesAnEllipsoidWithinTheAnglesOnceFineEnough) {
  const Eigen::Vector3d radii(5.0, 3.0, 4.0);  // smallest radius of curvature: 3^2 / 5 = 1.8
  const std::vector<Point> seeds{Point(5.0, 0.0, 0.0)};
  const Isosurface surface = grad_normal(ellipsoid(radii), 0.0, seeds, with_e(0.25));
  expect_solid(surface, 2);
  const auto angles = sorted_angles(surface.mesh);
  EXPECT_GT(angles.front(), 35.2);
  EXPECT_LT(angles.back(), 101.5);
  for (const Point& p : surface.mesh.vertices) EXPECT_NEAR(p.cwiseQuotient(radii).norm(), 1.0, 1e-6);
}

/// The field turned about the origin, which for the surface is as if the tiling were.
ScalarField turned(const ScalarField& field, const Eigen::Matrix3d& rotation) {
  return [field, rotation](const Point& p) {
    const FieldSample sample = field(rotation.transpose() * p);
    return FieldSample{sample.value, rotation * sample.gradient};
  };
}

/// Range of angles where e is a fifth of the smallest radius of curvature, wherever and however the tiling lies.
TEST(GradNormal, KeepsTheAnglesForAnyPlaceAndDirectionOfTheTiling) {
  const Eigen::Vector3d radii(1.6, 1.3, 1.45);
  const double e = 0.2 * 1.3 * 1.3 / 1.6;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Matrix3d rotation = (Eigen::AngleAxisd(0.7 * i, Eigen::Vector3d(1, 0.3 * i, -0.5).normalized()) *
                                      Eigen::AngleAxisd(0.4 * i, Eigen::Vector3d::UnitX()))
                                         .toRotationMatrix();
    IsosurfaceOptions options;
    options.e = e;
    options.origin = e * Point(0.13 * i, -0.29 * i, 0.41 * i);
    const ScalarField field = turned(ellipsoid(radii), rotation);
    const std::vector<Point> seeds{rotation * Point(1.6, 0.0, 0.0)};
    const Isosurface surface = grad_normal(field, 0.0, seeds, options);
    expect_solid(surface, 2);
    const auto angles = sorted_angles(surface.mesh);
    EXPECT_GT(angles.front(), 35.2) << i;
    EXPECT_LT(angles.back(), 101.55) << i;
    for (const Point& p : surface.mesh.vertices)
      EXPECT_NEAR((rotation.transpose() * p).cwiseQuotient(radii).norm(), 1.0, 1e-6);

    const Isosurface jagged = mid_normal(field, 0.0, seeds, options);
    expect_solid(jagged, 2);
    const auto tiling_angles = sorted_angles(jagged.mesh);
    EXPECT_NEAR(tiling_angles.front(), 45.0, 1e-6);
    EXPECT_NEAR(tiling_angles.back(), 90.0, 1e-6);
  }
}

/// A surface of a radius of curvature of e or less all over: no promise of angles, but a solid.
TEST(GradNormal, StaysASolidOnSurfacesAsSmallAsTheTiling) {
  for (const double radius : {0.35, 0.5, 0.7, 1.0})
    for (int i = 0; i < 5; ++i) {
      IsosurfaceOptions options;
      options.e = 0.5;
      options.origin = Point(0.11 * i, 0.07 * i, -0.05 * i);
      const std::vector<Point> seeds{Point(radius, 0.0, 0.0)};
      const Isosurface surface = grad_normal(sphere(radius), 0.0, seeds, options);
      expect_solid(surface, 2);
      for (const Point& p : surface.mesh.vertices) EXPECT_NEAR(p.norm(), radius, 1e-5);
    }
}

TEST(GradNormal, ScalesWithTheSurface) {
  const std::vector<Point> seeds{Point(2.0, 0.0, 0.0)}, seeds4{Point(8.0, 0.0, 0.0)};
  IsosurfaceOptions options = with_e(0.2);
  const Isosurface small = grad_normal(sphere(2.0), 0.0, seeds, options);
  options.e *= 4.0;
  options.origin *= 4.0;
  const Isosurface large = grad_normal(sphere(8.0), 0.0, seeds4, options);
  EXPECT_EQ(small.mesh.triangles, large.mesh.triangles);
  for (std::size_t v = 0; v < small.mesh.vertices.size(); ++v)
    EXPECT_LT((4.0 * small.mesh.vertices[v] - large.mesh.vertices[v]).norm(), 1e-5);
}

TEST(GradNormal, KeepsTheHoleOfATorus) {
  const std::vector<Point> seeds{Point(3.0, 0.0, 0.0)};
  expect_solid(grad_normal(torus(2.0, 1.0), 0.0, seeds, with_e(0.2)), 0);
}

TEST(GradNormal, WorkGrowsWithAreaOverSquaredSize) {
  const std::vector<Point> seeds{Point(2.0, 0.0, 0.0)};
  const Isosurface coarse = grad_normal(sphere(2.0), 0.0, seeds, with_e(0.2));
  const Isosurface fine = grad_normal(sphere(2.0), 0.0, seeds, with_e(0.05));
  EXPECT_NEAR(static_cast<double>(fine.visited_cells) / static_cast<double>(coarse.visited_cells), 16.0, 0.8);
  EXPECT_NEAR(static_cast<double>(fine.evaluated_vertices) / static_cast<double>(coarse.evaluated_vertices), 16.0, 1.6);
}

TEST(GradNormal, DoesNotDependOnTheNumberOfThreads) {
  const std::vector<Point> seeds{Point(3.0, 0.0, 0.0)};
  const auto run = [&](std::size_t threads) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    return grad_normal(torus(2.0, 1.0), 0.0, seeds, with_e(0.1)).mesh;
  };
  const TriangleMesh one = run(1);
  for (const std::size_t threads : {2U, 4U}) {
    const TriangleMesh other = run(threads);
    EXPECT_EQ(one.vertices, other.vertices);
    EXPECT_EQ(one.triangles, other.triangles);
  }
}

TEST(GradNormal, KeepsThePartThatMostSeedsTouchAndDropsBubbles) {
  const ScalarField two = [](const Point& p) {
    const FieldSample large = sphere(2.0)(p);
    FieldSample small = sphere(0.5)(p - Point(5.0, 0.0, 0.0));
    return large.value > small.value ? large : small;
  };
  const std::vector<Point> seeds{Point(5.5, 0.0, 0.0), Point(2.0, 0.0, 0.0), Point(0.0, 2.0, 0.0)};
  const Isosurface surface = grad_normal(two, 0.0, seeds, with_e(0.2));
  expect_solid(surface, 2);
  EXPECT_EQ(surface.dropped_components, 1U);
  EXPECT_NEAR(volume(surface.mesh), 4.0 / 3.0 * std::numbers::pi * 8.0, 0.5);
}

TEST(GradNormal, FindsTheSurfaceFromSeedsBesideIt) {
  const std::vector<Point> seeds{Point(0.9, 0.0, 0.0)};  // more than five cells below the surface
  expect_solid(grad_normal(sphere(2.0), 0.0, seeds, with_e(0.2)), 2);
}

TEST(GradNormal, FollowsTheIsoValue) {
  const std::vector<Point> seeds{Point(1.0, 0.0, 0.0)};
  const Isosurface surface = grad_normal(sphere(2.0), 0.75, seeds, with_e(0.1));
  for (const Point& p : surface.mesh.vertices) EXPECT_NEAR(p.norm(), 1.0, 1e-6);
}

TEST(GradNormal, SaysThatThereIsNoSurface) {
  const ScalarField nothing = [](const Point&) { return FieldSample{}; };
  const std::vector<Point> seeds{Point::Zero()};
  EXPECT_THROW(grad_normal(nothing, 0.5, seeds), NoResultError);
}

TEST(GradNormal, SaysThatASurfaceHasNoEnd) {
  const ScalarField plane = [](const Point& p) { return FieldSample{-p.z(), -Eigen::Vector3d::UnitZ()}; };
  const std::vector<Point> seeds{Point::Zero()};
  IsosurfaceOptions options;
  options.max_cells = 10000;
  EXPECT_THROW(grad_normal(plane, 0.0, seeds, options), NoResultError);
}

TEST(GradNormal, RefusesAHollow) {
  const ScalarField hollow = [](const Point& p) {
    const FieldSample solid = sphere(1.0)(p);
    return FieldSample{-solid.value, -solid.gradient};
  };
  const std::vector<Point> seeds{Point(1.0, 0.0, 0.0)};
  EXPECT_THROW(grad_normal(hollow, 0.0, seeds, with_e(0.2)), NoResultError);
}

TEST(GradNormal, RefusesBadInput) {
  const std::vector<Point> none, bad{Point(1.0, 0.0, 0.0), Point(std::nan(""), 0.0, 0.0)};
  EXPECT_THROW(grad_normal(sphere(1.0), 0.0, none), InputError);
  try {
    grad_normal(sphere(1.0), 0.0, bad);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.elements(), std::vector<std::int64_t>{1});
  }
  IsosurfaceOptions options;
  options.e = 0.0;
  const std::vector<Point> seeds{Point(1.0, 0.0, 0.0)};
  EXPECT_THROW(grad_normal(sphere(1.0), 0.0, seeds, options), UsageError);
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
