// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/adjacency.hpp"

#include "mesh/geometry.hpp"
#include "mesh/test_meshes.hpp"
#include "rhizodont/error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <set>

namespace rhizodont {
namespace {

using test::cube, test::grid, test::sphere, test::tetrahedron, test::together;

TEST(EdgeTable, ListsEachEdgeOnceWithItsHalfEdges) {
  const TriangleMesh mesh = cube();
  const EdgeTable table = edge_table(mesh);
  ASSERT_EQ(table.size(), 18U);
  EXPECT_TRUE(std::is_sorted(table.vertices.begin(), table.vertices.end()));
  for (std::size_t e = 0; e < table.size(); ++e) {
    ASSERT_EQ(table.triangle_count(e), 2);
    for (int k = table.first[e]; k < table.first[e + 1]; ++k) {
      const int h = table.half_edges[static_cast<std::size_t>(k)];
      EXPECT_EQ(std::min(half_edge_from(mesh, h), half_edge_to(mesh, h)), table.vertices[e][0]);
      EXPECT_EQ(std::max(half_edge_from(mesh, h), half_edge_to(mesh, h)), table.vertices[e][1]);
    }
  }
}

TEST(TriangleAdjacencyTest, NeighboursShareTheEdgeAndKnowEachOther) {
  const TriangleMesh mesh = sphere(2);
  const auto neighbours = triangle_adjacency(mesh).neighbours;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i) {
      const int n = neighbours[t][i];
      ASSERT_GE(n, 0);
      const Triangle& other = mesh.triangles[static_cast<std::size_t>(n)];
      for (const std::size_t c : {i, (i + 1) % 3})
        EXPECT_TRUE(std::find(other.begin(), other.end(), mesh.triangles[t][c]) != other.end());
      const auto& back = neighbours[static_cast<std::size_t>(n)];
      EXPECT_EQ(std::count(back.begin(), back.end(), static_cast<int>(t)), 1);
    }
}

TEST(TriangleAdjacencyTest, BorderIsMinusOne) {
  const auto neighbours =
      triangle_adjacency({{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}}).neighbours;
  EXPECT_EQ(neighbours[0], (std::array<int, 3>{-1, -1, 1}));
  EXPECT_EQ(neighbours[1], (std::array<int, 3>{0, -1, -1}));
}

TEST(TriangleAdjacencyTest, NamesTheEdgeWithThreeTriangles) {
  const TriangleMesh fins{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, -1, 0}}, {{0, 1, 2}, {0, 1, 3}, {1, 0, 4}}};
  try {
    triangle_adjacency(fins);
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_EQ(error.elements(), (std::vector<std::int64_t>{0, 1}));
  }
}

TEST(TriangleAdjacencyTest, NamesTriangleWithIndexOutOfRange) {
  for (const int bad : {-1, 4}) {
    TriangleMesh mesh = tetrahedron();
    mesh.triangles[2][1] = bad;
    try {
      triangle_adjacency(mesh);
      FAIL() << "no error";
    } catch (const InputError& error) {
      EXPECT_EQ(error.elements(), std::vector<std::int64_t>{2});
    }
  }
}

TEST(VertexTrianglesTest, HoldsEachCornerOnce) {
  const TriangleMesh mesh = sphere(1);
  const VertexTriangles around = vertex_triangles(mesh);
  ASSERT_EQ(around.triangles.size(), 3 * mesh.triangles.size());
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    for (int k = around.first[v]; k < around.first[v + 1]; ++k) {
      const Triangle& t = mesh.triangles[static_cast<std::size_t>(around.triangles[static_cast<std::size_t>(k)])];
      EXPECT_EQ(std::count(t.begin(), t.end(), static_cast<int>(v)), 1);
      if (k > around.first[v]) {
        EXPECT_LT(around.triangles[static_cast<std::size_t>(k - 1)], around.triangles[static_cast<std::size_t>(k)]);
      }
    }
}

TEST(BorderLoops, GridHasOneLoopWithTheMeshToItsLeft) {
  const TriangleMesh mesh = grid(3);
  const auto loops = border_loops(mesh);
  ASSERT_EQ(loops.size(), 1U);
  EXPECT_EQ(loops[0].size(), 12U);
  EXPECT_EQ(loops[0].front(), 0);
  // seen from above, counterclockwise around the square: twice the enclosed area is positive
  double twice_area = 0;
  for (std::size_t k = 0; k < loops[0].size(); ++k) {
    const Point& p = mesh.vertices[static_cast<std::size_t>(loops[0][k])];
    const Point& q = mesh.vertices[static_cast<std::size_t>(loops[0][(k + 1) % loops[0].size()])];
    twice_area += p.x() * q.y() - p.y() * q.x();
  }
  EXPECT_DOUBLE_EQ(twice_area, 18);
}

TEST(BorderLoops, HoleRunsTheOtherWay) {
  TriangleMesh mesh = grid(3);
  mesh.triangles.erase(mesh.triangles.begin() + 8, mesh.triangles.begin() + 10);  // the middle square
  const auto loops = border_loops(mesh);
  ASSERT_EQ(loops.size(), 2U);
  EXPECT_EQ(loops[1], (std::vector<int>{5, 9, 10, 6}));
}

TEST(BorderLoops, FlippedMeshHasReversedLoops) {
  auto loops = border_loops(grid(2)), reversed = border_loops(flipped(grid(2)));
  ASSERT_EQ(loops.size(), 1U);
  std::reverse(loops[0].begin() + 1, loops[0].end());
  EXPECT_EQ(loops, reversed);
}

TEST(BorderLoops, ClosedMeshHasNone) { EXPECT_TRUE(border_loops(sphere(1)).empty()); }

TEST(BorderLoops, NamesVertexWhereLoopsTouch) {
  const TriangleMesh bow{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}}, {{0, 1, 2}, {0, 3, 4}}};
  try {
    border_loops(bow);
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_EQ(error.elements(), std::vector<std::int64_t>{0});
  }
}

TEST(BorderLoops, RefusesTrianglesTurnedAgainstEachOther) {
  const TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 3, 2}}};
  EXPECT_THROW(border_loops(mesh), InputError);
}

TEST(ConnectedComponentsTest, AVertexAloneDoesNotJoin) {
  const TriangleMesh bow{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}}, {{0, 1, 2}, {0, 3, 4}}};
  EXPECT_EQ(connected_components(bow).count, 2);
  EXPECT_EQ(connected_components(together(cube(), sphere(1), {5, 0, 0})).count, 2);
  EXPECT_EQ(connected_components(sphere(2)).count, 1);
}

TEST(ConnectedComponentsTest, NumbersByFirstAppearance) {
  TriangleMesh mesh = together(tetrahedron(), tetrahedron(), {5, 0, 0});
  std::swap(mesh.triangles[1], mesh.triangles[6]);
  EXPECT_EQ(connected_components(mesh).of_triangle, (std::vector<int>{0, 1, 0, 0, 1, 1, 0, 1}));
}

TEST(SubmeshTest, KeepsOrderAndCoordinates) {
  const TriangleMesh mesh = sphere(2);
  std::vector<bool> mask(mesh.triangles.size());
  for (std::size_t t = 0; t < mask.size(); ++t) mask[t] = t % 3 == 0;
  const Submesh part = submesh(mesh, mask);
  ASSERT_EQ(part.mesh.triangles.size(), (mesh.triangles.size() + 2) / 3);
  for (std::size_t t = 0; t < part.mesh.triangles.size(); ++t) {
    EXPECT_EQ(part.old_triangles[t], static_cast<int>(3 * t));
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_EQ(part.old_vertices[static_cast<std::size_t>(part.mesh.triangles[t][i])], mesh.triangles[3 * t][i]);
  }
  for (std::size_t v = 0; v < part.mesh.vertices.size(); ++v)
    EXPECT_EQ(part.mesh.vertices[v], mesh.vertices[static_cast<std::size_t>(part.old_vertices[v])]);
  EXPECT_TRUE(std::is_sorted(part.old_vertices.begin(), part.old_vertices.end()));
}

TEST(SubmeshTest, CompactDropsOnlyUnreferencedVertices) {
  TriangleMesh mesh = tetrahedron();
  mesh.vertices.insert(mesh.vertices.begin() + 1, Point(9, 9, 9));
  for (Triangle& t : mesh.triangles)
    for (auto& v : t) v += v >= 1;
  const Submesh part = compact(mesh);
  EXPECT_EQ(part.old_vertices, (std::vector<int>{0, 2, 3, 4}));
  EXPECT_EQ(part.mesh.triangles, tetrahedron().triangles);
}

TEST(SubmeshTest, RefusesMaskOfAnotherLength) { EXPECT_THROW(submesh(cube(), std::vector<bool>(3, true)), UsageError); }

TEST(Flipped, NegatesVolumeAndUndoesItself) {
  EXPECT_DOUBLE_EQ(volume(flipped(cube())), -1);
  EXPECT_EQ(flipped(flipped(cube())).triangles, cube().triangles);
}

TEST(EdgeBend, RightAnglesOfACubeAndFlatDiagonals) {
  TriangleMesh mesh = test::cube();
  for (const double sign : {1.0, -1.0}) {
    const EdgeTable table = edge_table(mesh);
    int bent = 0;
    for (std::size_t e = 0; e < table.size(); ++e) {
      const double length = (mesh.vertices[static_cast<std::size_t>(table.vertices[e][0])] -
                             mesh.vertices[static_cast<std::size_t>(table.vertices[e][1])])
                                .norm();
      const bool diagonal = length > 1.2;
      EXPECT_NEAR(edge_bend(mesh, table, e), diagonal ? 0 : sign * std::numbers::pi / 2, 1e-12);
      bent += diagonal ? 0 : 1;
    }
    EXPECT_EQ(bent, 12);
    mesh = flipped(mesh);  // seen from inside every edge is a crease
  }
  // A border; an edge of three triangles; a triangle without area beside one that looks to negative x, y and z.
  const std::vector<Point> points{{0, 0, 0}, {1, 0, -1}, {0, 1, -1}, {0, 0, 1}, {-1, -1, 1}, {0.5, 0, -0.5}};
  for (const std::vector<Triangle>& triangles :
       {std::vector<Triangle>{{0, 1, 2}}, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}, {{0, 2, 1}, {0, 1, 5}}}) {
    const TriangleMesh flat{points, triangles};
    const EdgeTable table = edge_table(flat);
    for (std::size_t e = 0; e < table.size(); ++e) EXPECT_EQ(edge_bend(flat, table, e), 0);
  }
}

}  // namespace
}  // namespace rhizodont
