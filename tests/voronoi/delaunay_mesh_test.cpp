// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "voronoi/delaunay_mesh.hpp"

#include "mesh/closest_point.hpp"
#include "mesh/diagnosis.hpp"
#include "mesh/geometry.hpp"
#include "mesh/test_meshes.hpp"
#include "rhizodont/error.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

namespace rhizodont {
namespace {

/// A bumpy surface of long triangles.
TriangleMesh stretched_bumps(int n) {
  TriangleMesh mesh = test::grid(n);
  for (Point& p : mesh.vertices) p = Point(4 * p.x(), p.y(), std::sin(2 * p.x()) + std::cos(p.y()));
  return mesh;
}

TEST(DelaunayMesh, TwoFlatTrianglesWithAnObtusePair) {
  // The edge from 0 to 1 is seen under two angles of about 127 degrees.
  const TriangleMesh kite{{{0, 0, 0}, {4, 0, 0}, {2, 1, 0}, {2, -1, 0}}, {{0, 1, 2}, {1, 0, 3}}};
  EXPECT_EQ(non_delaunay_edges(kite), (std::vector<std::array<int, 2>>{{0, 1}}));
  const DelaunayMesh result = make_delaunay_mesh(kite);
  EXPECT_TRUE(non_delaunay_edges(result.mesh).empty());
  ASSERT_EQ(result.steiner_edges.size(), 1U);
  EXPECT_EQ(result.steiner_edges[0], (std::array<int, 2>{0, 1}));
  EXPECT_EQ(result.mesh.vertices[4], Point(2, 0, 0));
  EXPECT_EQ(result.mesh.triangles.size(), 4U);
}

TEST(DelaunayMesh, KeepsTheSurfaceAndEndsDelaunay) {
  const TriangleMesh mesh = stretched_bumps(12);
  ASSERT_FALSE(non_delaunay_edges(mesh).empty());
  const DelaunayMesh result = make_delaunay_mesh(mesh);
  EXPECT_EQ(result.edges_left, 0);
  EXPECT_TRUE(non_delaunay_edges(result.mesh).empty());
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) EXPECT_EQ(result.mesh.vertices[v], mesh.vertices[v]);
  // Each input triangle is covered exactly by its pieces, which face the same way.
  std::map<int, double> area;
  for (std::size_t t = 0; t < result.mesh.triangles.size(); ++t) {
    const int parent = result.parent_triangle[t];
    area[parent] += triangle_area(result.mesh, t);
    EXPECT_GT(triangle_normal(result.mesh, t).dot(triangle_normal(mesh, static_cast<std::size_t>(parent))), 1 - 1e-9);
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    EXPECT_NEAR(area[static_cast<int>(t)], triangle_area(mesh, t), 1e-9);
  // Steiner points lie on their edges; the border has none.
  const Diagnosis d = diagnose(mesh);
  for (std::size_t i = 0; i < result.steiner_edges.size(); ++i) {
    const auto [a, b] = result.steiner_edges[i];
    const Point& p = result.mesh.vertices[mesh.vertices.size() + i];
    const Point &pa = mesh.vertices[static_cast<std::size_t>(a)], &pb = mesh.vertices[static_cast<std::size_t>(b)];
    EXPECT_NEAR((p - pa).norm() + (p - pb).norm(), (pb - pa).norm(), 1e-12);
    EXPECT_EQ(std::count(d.border_edges.begin(), d.border_edges.end(), std::array<int, 2>{a, b}), 0);
  }
  EXPECT_TRUE(diagnose(result.mesh).is_oriented_manifold());
}

TEST(DelaunayMesh, NeedlesEndWithinTheLimits) {
  TriangleMesh mesh = test::grid(6);
  for (Point& p : mesh.vertices) p.y() *= 1e-5;
  for (std::size_t v = 0; v < mesh.vertices.size(); v += 3) mesh.vertices[v].z() = 0.2;
  const DelaunayMesh result = make_delaunay_mesh(mesh);
  EXPECT_LE(result.steiner_edges.size(), 4 * mesh.vertices.size());
  EXPECT_TRUE(diagnose(result.mesh).is_oriented_manifold());
}

TEST(DelaunayMesh, ADelaunayMeshIsLeftAlone) {
  const TriangleMesh ball = test::sphere(3);
  ASSERT_TRUE(non_delaunay_edges(ball).empty());
  const DelaunayMesh result = make_delaunay_mesh(ball);
  EXPECT_TRUE(result.steiner_edges.empty());
  EXPECT_EQ(result.mesh.triangles, ball.triangles);
}

TEST(DelaunayMesh, FlippedNeighboursAreRefused) {
  const TriangleMesh turned{{{0, 0, 0}, {4, 0, 0}, {2, 1, 0}, {2, -1, 0}}, {{0, 1, 2}, {0, 1, 3}}};
  EXPECT_THROW(make_delaunay_mesh(turned), InputError);
}

TEST(StrongDelaunay, HoldsForADenseSphereAndFailsAfterAFlip) {
  TriangleMesh ball = test::sphere(3);
  EXPECT_TRUE(test_strong_delaunay(ball).holds());
  // Flip one edge: the two new triangles are not in the dual.
  const Triangle first = ball.triangles[0];
  for (std::size_t t = 1; t < ball.triangles.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      Triangle& second = ball.triangles[t];
      if (second[i] != first[1] || second[(i + 1) % 3] != first[0]) continue;
      const int d = second[(i + 2) % 3];
      second = {d, first[1], first[2]};
      ball.triangles[0] = {first[0], d, first[2]};
      const StrongDelaunay result = test_strong_delaunay(ball);
      EXPECT_FALSE(result.holds());
      EXPECT_EQ(result.missing, 2);
      EXPECT_EQ(result.additional, 2);
      return;
    }
  }
  FAIL() << "no neighbour found";
}

TEST(StrongDelaunay, AThinPlateIsDelaunayButNotStrong) {
  // Two sheets nearer to each other than their edges are long: cells reach through.
  TriangleMesh plate = test::grid(4);
  const auto n = static_cast<std::int32_t>(plate.vertices.size());
  TriangleMesh below = plate;
  for (Point& p : below.vertices) p += Point(0.3, 0.4, -0.05);
  for (const Point& p : below.vertices) plate.vertices.push_back(p);
  for (const auto& [a, b, c] : below.triangles) plate.triangles.push_back({a + n, c + n, b + n});
  EXPECT_FALSE(test_strong_delaunay(plate).holds());
}

}  // namespace
}  // namespace rhizodont
