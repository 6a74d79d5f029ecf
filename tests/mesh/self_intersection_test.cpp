// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/self_intersection.hpp"

#include "mesh/test_meshes.hpp"
#include "rhizodont/error.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace rhizodont {
namespace {

using Pairs = std::vector<std::pair<int, int>>;
using test::cube, test::grid, test::sphere, test::tetrahedron, test::together, test::torus;

TEST(SelfIntersection, ProperMeshesHaveNone) {
  for (const TriangleMesh& mesh : {tetrahedron(), cube(), sphere(4), torus(30, 20), grid(10), TriangleMesh{}})
    EXPECT_TRUE(self_intersecting_triangles(mesh).empty());
}

TEST(SelfIntersection, FinsOnOneEdgeAreOrdinaryNeighbours) {
  const TriangleMesh fins{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, -1, 0}}, {{0, 1, 2}, {0, 1, 3}, {1, 0, 4}}};
  EXPECT_TRUE(self_intersecting_triangles(fins).empty());
}

TEST(SelfIntersection, NamesTheCrossingPair) {
  TriangleMesh mesh = together(grid(1), {{{0.6, 0.3, -1}, {0.7, 0.35, -1}, {0.65, 0.3, 1}}, {{0, 1, 2}}}, {0, 0, 0});
  EXPECT_EQ(self_intersecting_triangles(mesh), (Pairs{{0, 2}}));
  mesh.vertices.back().z() = -1e-300;  // just misses
  EXPECT_TRUE(self_intersecting_triangles(mesh).empty());
  mesh.vertices.back().z() = 0;  // just touches
  EXPECT_EQ(self_intersecting_triangles(mesh), (Pairs{{0, 2}}));
}

TEST(SelfIntersection, OverlappingSpheresMeetShiftedOnesDoNot) {
  EXPECT_FALSE(self_intersecting_triangles(together(sphere(2), sphere(2), {0.5, 0.1, 0.2})).empty());
  EXPECT_TRUE(self_intersecting_triangles(together(sphere(2), sphere(2), {2.1, 0, 0})).empty());
  EXPECT_TRUE(self_intersecting_triangles(together(sphere(2), sphere(2, 0.5), {0, 0, 0})).empty());
}

TEST(SelfIntersection, FoldOverASharedEdge) {
  // both triangles on the same side of edge 0-1 in one plane; and the same folded up by a hair
  TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0.5, 1, 0}, {0.4, 0.7, 0}}, {{0, 1, 2}, {1, 0, 3}}};
  EXPECT_EQ(self_intersecting_triangles(mesh), (Pairs{{0, 1}}));
  mesh.vertices[3].z() = 1e-200;
  EXPECT_TRUE(self_intersecting_triangles(mesh).empty());
}

TEST(SelfIntersection, SharedCornerButCrossing) {
  // triangle 1 starts at vertex 0 and pierces triangle 0
  TriangleMesh mesh{{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {1, 0.5, 1}, {1, 0.5, -1}}, {{0, 1, 2}, {0, 3, 4}}};
  EXPECT_EQ(self_intersecting_triangles(mesh), (Pairs{{0, 1}}));
  mesh.vertices[3] = {-1, 0.5, 1};
  mesh.vertices[4] = {-1, 0.5, -1};
  EXPECT_TRUE(self_intersecting_triangles(mesh).empty());
}

TEST(SelfIntersection, SharedCornerInOnePlane) {
  TriangleMesh mesh{{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {1, 0.2, 0}, {0.2, 1, 0}}, {{0, 1, 2}, {0, 3, 4}}};
  EXPECT_EQ(self_intersecting_triangles(mesh), (Pairs{{0, 1}}));
  mesh.vertices[3] = {-1, -0.2, 0};
  mesh.vertices[4] = {-0.2, -1, 0};
  EXPECT_TRUE(self_intersecting_triangles(mesh).empty());
}

TEST(SelfIntersection, SameTriangleTwice) {
  TriangleMesh mesh = tetrahedron();
  mesh.triangles.push_back({2, 1, 0});
  EXPECT_EQ(self_intersecting_triangles(mesh), (Pairs{{0, 4}}));
}

TEST(SelfIntersection, FlatTriangleCountsAsItsSegment) {
  const TriangleMesh through =
      together({{{0.5, 0.2, -1}, {0.5, 0.2, 0.5}, {0.5, 0.2, 1}}, {{0, 1, 2}}}, grid(1), {0, 0, 0});
  EXPECT_EQ(self_intersecting_triangles(through), (Pairs{{0, 1}}));
  const TriangleMesh point = together({{{0.5, 0.2, 0}, {0.5, 0.2, 0}, {0.5, 0.2, 0}}, {{0, 1, 2}}}, grid(1), {0, 0, 0});
  EXPECT_EQ(self_intersecting_triangles(point), (Pairs{{0, 1}}));
  const TriangleMesh away = together({{{5, 0, -1}, {5, 0, 0}, {5, 0, 1}}, {{0, 1, 2}}}, grid(1), {0, 0, 0});
  EXPECT_TRUE(self_intersecting_triangles(away).empty());
}

TEST(SelfIntersection, RepeatedIndexIsNoCrossing) {
  TriangleMesh mesh = tetrahedron();
  mesh.triangles.push_back({0, 0, 1});
  EXPECT_TRUE(self_intersecting_triangles(mesh).empty());
}

TEST(SelfIntersection, RefusesBadInput) {
  TriangleMesh mesh = cube();
  mesh.vertices[2].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(self_intersecting_triangles(mesh), InputError);
  mesh = cube();
  mesh.triangles[1][2] = 99;
  EXPECT_THROW(self_intersecting_triangles(mesh), InputError);
}

}  // namespace
}  // namespace rhizodont
