// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/geometry.hpp"

#include "mesh/adjacency.hpp"
#include "mesh/quality.hpp"
#include "mesh/test_meshes.hpp"
#include "rhizodont/error.hpp"

#include <gtest/gtest.h>

namespace rhizodont {
namespace {

using test::cube, test::grid, test::sphere, test::tetrahedron, test::torus;

constexpr double pi = std::numbers::pi;

TriangleMesh one_triangle(const Point& a, const Point& b, const Point& c) { return {{a, b, c}, {{0, 1, 2}}}; }

TriangleMesh moved(TriangleMesh mesh, const Eigen::Matrix3d& turn, const Eigen::Vector3d& shift) {
  for (Point& p : mesh.vertices) p = turn * p + shift;
  return mesh;
}

Eigen::Matrix3d some_turn() { return Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix(); }

TEST(Geometry, ClosedForms) {
  EXPECT_NEAR(volume(tetrahedron()), 1.0 / 6, 1e-15);
  EXPECT_NEAR(volume(cube()), 1, 1e-15);
  EXPECT_NEAR(surface_area(cube()), 6, 1e-15);
  EXPECT_NEAR(mean_edge_length(cube()), (12 + 6 * std::sqrt(2)) / 18, 1e-15);
  EXPECT_NEAR(area_vector(cube()).norm(), 0, 1e-15);
  EXPECT_TRUE(area_vector(grid(3)).isApprox(Eigen::Vector3d(0, 0, 9)));
  EXPECT_TRUE(area_centroid(grid(4)).isApprox(Point(2, 2, 0)));
  EXPECT_TRUE(bounding_box(cube().vertices).max().isApprox(Point(1, 1, 1)));
  EXPECT_TRUE(bounding_box({}).isEmpty());
  EXPECT_EQ(mean_edge_length({}), 0);
}

TEST(Geometry, SphereAndTorusApproachTheirFormulas) {
  EXPECT_NEAR(volume(sphere(5, 2)) / (4.0 / 3 * pi * 8), 1, 2e-3);
  EXPECT_NEAR(surface_area(sphere(5, 2)) / (4 * pi * 4), 1, 2e-3);
  EXPECT_NEAR(volume(torus(200, 100)) / (2 * pi * pi * 2 * 0.49), 1, 2e-3);
}

TEST(Geometry, RigidMotionChangesNothingIntrinsic) {
  const TriangleMesh here = torus(20, 10), there = moved(here, some_turn(), {30, -20, 10});
  EXPECT_NEAR(volume(there), volume(here), 1e-12);
  EXPECT_NEAR(surface_area(there), surface_area(here), 1e-11);
  const auto normals = vertex_normals(here), turned = vertex_normals(there);
  for (std::size_t v = 0; v < normals.size(); ++v) EXPECT_LT((some_turn() * normals[v] - turned[v]).norm(), 1e-12);
}

TEST(Geometry, AreaVectorDependsOnTheBorderAlone) {
  TriangleMesh bulged = grid(4);
  bulged.vertices[12] += Point(0.2, -0.1, 3);  // the middle vertex
  EXPECT_TRUE(area_vector(bulged).isApprox(area_vector(grid(4)), 1e-14));
}

TEST(Geometry, VertexNormalsOfACubePointAlongTheDiagonals) {
  // Angle weights make the answer independent of how the squares are cut in two.
  const auto normals = vertex_normals(cube());
  for (std::size_t v = 0; v < 8; ++v)
    EXPECT_LT((normals[v] - (cube().vertices[v] - Point(0.5, 0.5, 0.5)).normalized()).norm(), 1e-15);
}

TEST(Geometry, NormalsAtSomeVerticesAreTheVerySame) {
  const TriangleMesh mesh = cube();
  const auto all = vertex_normals(mesh);
  const std::vector<int> some{6, 1, 3, 1};
  const auto normals = vertex_normals_at(mesh, some);
  ASSERT_EQ(normals.size(), some.size());
  for (std::size_t k = 0; k < some.size(); ++k) EXPECT_EQ(normals[k], all[static_cast<std::size_t>(some[k])]);
  EXPECT_TRUE(vertex_normals_at(mesh, {}).empty());
}

TEST(Geometry, AnglesSumToPiEvenForNeedles) {
  const TriangleMesh needle = one_triangle({0, 0, 0}, {1, 0, 0}, {0.5, 1e-9, 0});
  const auto angles = triangle_angles(needle, 0);
  EXPECT_NEAR(angles[0] + angles[1] + angles[2], pi, 1e-15);
  EXPECT_NEAR(angles[0], 2e-9, 1e-20);
}

TEST(Geometry, NoAreaGivesZeroNormalNotNaN) {
  const TriangleMesh flat = one_triangle({0, 0, 0}, {1, 1, 1}, {2, 2, 2});
  EXPECT_EQ(triangle_normal(flat, 0), Eigen::Vector3d::Zero());
  for (const auto& normal : vertex_normals(flat)) EXPECT_EQ(normal, Eigen::Vector3d::Zero());
  EXPECT_THROW(area_centroid(flat), InputError);
  EXPECT_THROW(area_centroid({}), InputError);
}

TEST(Quality, EquilateralIsPerfect) {
  const auto figures = quality(one_triangle({0, 0, 0}, {1, 0, 0}, {0.5, std::sqrt(3) / 2, 0}));
  ASSERT_TRUE(figures);
  EXPECT_NEAR(figures->q_avg, 1, 1e-14);
  EXPECT_NEAR(figures->theta_min, 60, 1e-12);
  EXPECT_NEAR(figures->theta_max, 60, 1e-12);
  EXPECT_EQ(figures->percent_below_30, 0);
}

TEST(Quality, RightIsoscelesByFormula) {
  // S = 1/2, p = (2 + sqrt 2) / 2, h = sqrt 2
  const double expected = 6 * 0.5 / (std::sqrt(3) * (2 + std::sqrt(2)) / 2 * std::sqrt(2));
  const auto figures = quality(grid(3));
  ASSERT_TRUE(figures);
  EXPECT_NEAR(figures->q_avg, expected, 1e-14);
  EXPECT_NEAR(figures->q_min, expected, 1e-14);
  EXPECT_NEAR(figures->theta_avg, 45, 1e-12);
  EXPECT_NEAR(figures->theta_max, 90, 1e-12);
  EXPECT_EQ(figures->triangles, 18U);
}

TEST(Quality, CountsAnglesBelow30) {
  // angles of 10, 10 and 160 degrees beside a right isosceles triangle
  TriangleMesh mesh = one_triangle({0, 0, 0}, {2, 0, 0}, {1, std::tan(10 * pi / 180), 0});
  mesh.vertices.emplace_back(1, -1, 0);
  mesh.triangles.push_back({0, 3, 1});
  const auto figures = quality(mesh);
  ASSERT_TRUE(figures);
  EXPECT_NEAR(figures->percent_below_30, 100.0 * 2 / 6, 1e-12);
  EXPECT_NEAR(figures->theta_min, 10, 1e-10);
  EXPECT_NEAR(figures->theta_avg, (10 + 45) / 2.0, 1e-10);
  EXPECT_NEAR(figures->theta_max, 160, 1e-10);
  EXPECT_NEAR(quality(mesh, {false, true})->theta_min, 45, 1e-12);
}

TEST(Quality, ThirtyDegreesAreTheBound) {
  const auto isosceles = [](double degrees) {
    return one_triangle({0, 0, 0}, {2, 0, 0}, {1, std::tan(degrees * pi / 180), 0});
  };
  EXPECT_NEAR(quality(isosceles(29.9))->percent_below_30, 100.0 * 2 / 3, 1e-12);
  EXPECT_EQ(quality(isosceles(30.1))->percent_below_30, 0);
}

TEST(Quality, DegenerateIsZeroAndEmptyHasNoFigures) {
  EXPECT_EQ(triangle_quality(one_triangle({1, 1, 1}, {1, 1, 1}, {1, 1, 1}), 0), 0);
  EXPECT_EQ(triangle_quality(one_triangle({0, 0, 0}, {1, 0, 0}, {3, 0, 0}), 0), 0);
  EXPECT_FALSE(quality(TriangleMesh{}));
  EXPECT_FALSE(quality(cube(), std::vector<bool>(12, false)));
  EXPECT_THROW(quality(cube(), {true}), UsageError);
}

TEST(Quality, ScaleAndMotionDoNotMatter) {
  const TriangleMesh here = torus(20, 7), there = moved(here, 7.5 * some_turn(), {3, 2, 1});
  EXPECT_NEAR(quality(here)->q_avg, quality(there)->q_avg, 1e-13);
  EXPECT_NEAR(quality(here)->theta_min, quality(there)->theta_min, 1e-11);
}

}  // namespace
}  // namespace rhizodont
