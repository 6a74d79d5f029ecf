// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/self_intersection.hpp"

#include "mesh/test_meshes.hpp"
#include "rhizodont/error.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

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

/// Triangles at random about one vertex, which they all have.
TriangleMesh wild_fan(int triangles) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> coordinate(-1, 1);
  TriangleMesh fan{{Point::Zero()}, {}};
  for (int t = 0; t < triangles; ++t) {
    const Point p{coordinate(random), coordinate(random), coordinate(random)};
    const Point step{coordinate(random), coordinate(random), coordinate(random)};
    fan.vertices.push_back(p);
    fan.vertices.emplace_back(p + 0.4 * step);
    fan.triangles.push_back({0, 2 * t + 1, 2 * t + 2});
  }
  fan.triangles.push_back(fan.triangles.front());  // twice
  fan.triangles.push_back({1, 7, 9});              // across others
  return fan;
}

/// Pairs that a test of the whole finds, but for those among the first `clear` triangles.
Pairs without_clear_pairs(const TriangleMesh& mesh, int clear) {
  Pairs all = self_intersecting_triangles(mesh);
  std::erase_if(all, [&](const auto& pair) { return pair.first < clear && pair.second < clear; });
  return all;
}

TEST(SelfIntersection, PairsThatAreKnownToBeClearAreLeftOut) {
  const TriangleMesh spheres = together(sphere(3), sphere(3), {0.5, 0.1, 0.2}), fan = wild_fan(700);
  ASSERT_FALSE(self_intersecting_triangles(spheres).empty());
  for (const TriangleMesh& mesh : {spheres, fan}) {
    const int count = static_cast<int>(mesh.triangles.size());
    for (const int clear : {0, 1, count / 3, count / 2, count - 2, count})
      EXPECT_EQ(self_intersecting_triangles(mesh, static_cast<std::size_t>(clear)), without_clear_pairs(mesh, clear))
          << clear << " of " << count;
  }
}

TEST(SelfIntersection, ACrowdAroundOneVertexIsSearchedByDirectionsWithTheSameResult) {
  const TriangleMesh fan = wild_fan(700);
  const Pairs found = self_intersecting_triangles(fan);
  EXPECT_GT(found.size(), 500U);
  // Among many more triangles the vertex is none that very many have: all pairs of boxes are looked at.
  TriangleMesh among_others = fan;
  for (int k = 0; k < 50000; ++k) {
    const auto first = static_cast<std::int32_t>(among_others.vertices.size());
    for (const Point& p : {Point(0, 0, 0), Point(0.5, 0, 0), Point(0, 0.5, 0)})
      among_others.vertices.emplace_back(p + Point(10 + k % 200, k / 200, 0));
    among_others.triangles.push_back({first, first + 1, first + 2});
  }
  EXPECT_EQ(self_intersecting_triangles(among_others), found);
}

TEST(SelfIntersection, AFlatFanOfManyTrianglesHasNone) {
  constexpr int count = 20000;
  TriangleMesh fan{{Point::Zero()}, {}};
  for (int k = 0; k <= count; ++k) {
    const double angle = 6.0 * k / count;
    fan.vertices.emplace_back(std::cos(angle), std::sin(angle), 0.5 * std::cos(angle));
  }
  for (int k = 1; k <= count; ++k) fan.triangles.push_back({0, k, k + 1});
  EXPECT_TRUE(self_intersecting_triangles(fan).empty());
}

TEST(MeetingMesh, SaysWhatTheTestOfAllPairsSays) {
  const TriangleMesh mesh = torus(30, 20);
  std::mt19937 random(7);
  std::uniform_int_distribution<int> vertex(0, static_cast<int>(mesh.vertices.size()) - 1);
  std::vector<Triangle> others;
  while (others.size() < 60) {
    const Triangle t{vertex(random), vertex(random), vertex(random)};
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) others.push_back(t);
  }
  for (std::size_t i = 0; i < 40; ++i) others.push_back({mesh.triangles[i][0], mesh.triangles[i][1], vertex(random)});
  const std::vector<bool> meeting = meeting_mesh(mesh, others);
  int count = 0;
  for (std::size_t i = 0; i < others.size(); ++i) {
    TriangleMesh with = mesh;
    with.triangles.push_back(others[i]);
    EXPECT_EQ(meeting[i], !self_intersecting_triangles(with).empty()) << i;
    count += meeting[i];
  }
  EXPECT_GT(count, 5);
  EXPECT_LT(count, 95);
}

TEST(MeetingMesh, ASegmentIsATriangleWithACornerTwice) {
  TriangleMesh mesh = grid(1);
  mesh.vertices.insert(mesh.vertices.end(), {{0.6, 0.3, -1}, {0.65, 0.3, 1}, {0.65, 0.3, -0.5}});
  const auto n = static_cast<std::int32_t>(mesh.vertices.size());
  EXPECT_EQ(meeting_mesh(mesh, {{n - 3, n - 2, n - 2}, {n - 3, n - 1, n - 1}, {0, 1, 1}}),
            (std::vector<bool>{true, false, false}));
  EXPECT_TRUE(meeting_mesh(mesh, {}).empty());
  EXPECT_THROW(meeting_mesh(mesh, {{0, 1, n}}), InputError);
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
