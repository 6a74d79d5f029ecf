// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "operators/geodesic.hpp"

#include "operators/surfaces.hpp"
#include "rhizodont/error.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace rhizodont {
namespace {

TEST(GeodesicDistances, OnASphereAreAngles) {
  const TriangleMesh mesh = test::sphere(5, 2);
  const auto distance = geodesic_distances(mesh, {4});  // (0, 0, 2)
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const double expected = 2 * std::acos(std::clamp(mesh.vertices[v].z() / 2, -1.0, 1.0));
    EXPECT_NEAR(distance[v], expected, 0.05 * expected + 0.04);
  }
}

TEST(GeodesicDistances, FromASideOfARectangleAreHeights) {
  const TriangleMesh mesh = test::rectangle(16, 16, 2, 2);
  std::vector<int> side;
  for (int i = 0; i <= 16; ++i) side.push_back(i);
  const auto distance = geodesic_distances(mesh, side);
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) EXPECT_NEAR(distance[v], mesh.vertices[v].y(), 1e-9);
}

TEST(GeodesicDistances, GoAroundAHole) {
  TriangleMesh mesh = test::rectangle(20, 20, 1, 1);
  std::erase_if(mesh.triangles, [&](const Triangle& t) {  // a wall from below, open at the top
    const Point middle =
        (mesh.vertices[static_cast<std::size_t>(t[0])] + mesh.vertices[static_cast<std::size_t>(t[1])] +
         mesh.vertices[static_cast<std::size_t>(t[2])]) /
        3;
    return std::abs(middle.x() - 0.5) < 0.05 && middle.y() < 0.8;
  });
  const auto distance = geodesic_distances(mesh, {0});
  const double around = std::hypot(0.45, 0.8) + 0.1 + std::hypot(0.45, 0.8);
  EXPECT_NEAR(distance[20], around, 0.06 * around);
}

TEST(GeodesicDistances, ComeToAnEndOnASurfacePressedFlat) {
  // Folded onto a plane, with slivers where it turns: vertices shorten each other's way by rounding, again and again.
  TriangleMesh mesh = test::dome(4, 4);
  const Eigen::Vector3d axis = Eigen::Vector3d(0.3, 0.9, 0.4).normalized();
  for (Point& p : mesh.vertices) p -= p.dot(axis) * axis;
  std::vector<int> sources;
  for (int v = 0; v < static_cast<int>(mesh.vertices.size()); v += 50) sources.push_back(v);
  for (const double d : geodesic_distances(mesh, sources)) {
    EXPECT_GE(d, 0);
    EXPECT_LT(d, 4);
  }
}

TEST(GeodesicDistances, WithoutAWayAreInfinite) {
  TriangleMesh mesh = test::tetrahedron();
  mesh.vertices.emplace_back(5, 5, 5);
  EXPECT_TRUE(std::isinf(geodesic_distances(mesh, {0})[4]));
  EXPECT_TRUE(std::isinf(geodesic_distances(mesh, {})[0]));
  mesh.triangles.push_back({0, 1, 9});
  EXPECT_THROW(geodesic_distances(mesh, {0}), InputError);
}

}  // namespace
}  // namespace rhizodont
