// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/diagnosis.hpp"

#include "mesh/adjacency.hpp"
#include "mesh/test_meshes.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace rhizodont {
namespace {

using Edges = std::vector<std::array<int, 2>>;
using Ids = std::vector<int>;
using test::cube, test::grid, test::sphere, test::tetrahedron, test::together, test::torus;

TEST(Diagnose, ClosedSolidsAreClean) {
  for (const TriangleMesh& mesh : {tetrahedron(), cube(), sphere(3)}) {
    const Diagnosis found = diagnose(mesh);
    EXPECT_TRUE(found.is_closed_solid());
    EXPECT_EQ(found.euler_number, 2);
    EXPECT_EQ(found.genus, 0);
    EXPECT_TRUE(describe_defects(found).empty());
  }
}

TEST(Diagnose, TorusHasGenusOne) {
  const Diagnosis found = diagnose(torus(12, 8));
  EXPECT_TRUE(found.is_closed_manifold());
  EXPECT_EQ(found.genus, 1);
  EXPECT_FALSE(found.is_closed_solid());
}

TEST(Diagnose, InsideOutIsNoSolid) {
  const Diagnosis found = diagnose(flipped(cube()));
  EXPECT_TRUE(found.is_closed_manifold());
  EXPECT_LT(found.volume, 0);
  EXPECT_FALSE(found.is_closed_solid());
}

TEST(Diagnose, TwoPiecesAreNoSolid) {
  const Diagnosis found = diagnose(together(cube(), sphere(1), {5, 0, 0}));
  EXPECT_EQ(found.components, 2);
  EXPECT_EQ(found.genus, 0);
  EXPECT_FALSE(found.is_closed_solid());
}

TEST(Diagnose, OpenMeshHasABorder) {
  const Diagnosis found = diagnose(grid(2));
  EXPECT_EQ(found.border_edges.size(), 8U);
  EXPECT_EQ(found.border_loop_count, 1);
  EXPECT_EQ(found.euler_number, 1);
  EXPECT_TRUE(found.is_oriented_manifold());
  EXPECT_FALSE(found.is_closed_manifold());
  EXPECT_FALSE(found.genus);
  EXPECT_TRUE(describe_defects(found).empty());
}

TEST(Diagnose, NumbersAndIndices) {
  TriangleMesh mesh = tetrahedron();
  mesh.vertices.emplace_back(0, std::numeric_limits<double>::quiet_NaN(), 0);
  mesh.vertices.emplace_back(-0.0, 1, 0);
  mesh.triangles.push_back({0, 1, 6});
  mesh.triangles.push_back({-1, 1, 2});
  mesh.triangles.push_back({3, 2, 3});
  const Diagnosis found = diagnose(mesh);
  EXPECT_EQ(found.non_finite_vertices, Ids{4});
  EXPECT_EQ(found.out_of_range_triangles, (Ids{4, 5}));
  EXPECT_EQ(found.repeated_index_triangles, Ids{6});
  EXPECT_EQ(found.duplicate_vertices, Ids{5});
  EXPECT_EQ(found.unreferenced_vertices, (Ids{4, 5}));
  EXPECT_FALSE(found.is_valid());
  EXPECT_EQ(found.triangles, 4);
  EXPECT_EQ(describe_defects(found).size(), 5U);
}

TEST(Diagnose, DegenerateIsDecidedExactly) {
  TriangleMesh mesh{{{0, 0, 0}, {1, 1, 1}, {3, 3, 3}, {3, 3, std::nextafter(3.0, 4.0)}}, {{0, 1, 2}, {1, 0, 3}}};
  EXPECT_EQ(diagnose(mesh).degenerate_triangles, Ids{0});
}

TEST(Diagnose, DuplicateTriangleInAnyOrder) {
  TriangleMesh mesh = tetrahedron();
  mesh.triangles.push_back({1, 2, 0});
  const Diagnosis found = diagnose(mesh);
  EXPECT_EQ(found.duplicate_triangles, Ids{4});
  EXPECT_EQ(found.non_manifold_edges, (Edges{{0, 1}, {0, 2}, {1, 2}}));
  EXPECT_FALSE(found.is_oriented_manifold());
}

TEST(Diagnose, OneFlippedTriangle) {
  TriangleMesh mesh = tetrahedron();
  std::swap(mesh.triangles[2][0], mesh.triangles[2][1]);
  const Diagnosis found = diagnose(mesh);
  EXPECT_EQ(found.misoriented_edges.size(), 3U);
  EXPECT_TRUE(found.non_manifold_edges.empty());
  EXPECT_FALSE(found.is_closed_manifold());
}

TEST(Diagnose, VertexWhereTwoSolidsTouch) {
  TriangleMesh mesh = together(tetrahedron(), tetrahedron(), {1, 0, 0});
  for (Triangle& t : mesh.triangles)
    for (auto& v : t) v = v == 4 ? 1 : v;
  const Diagnosis found = diagnose(mesh);
  EXPECT_EQ(found.non_manifold_vertices, Ids{1});
  EXPECT_EQ(found.unreferenced_vertices, Ids{4});
  EXPECT_EQ(found.components, 1);
  EXPECT_EQ(connected_components(mesh).count, 2);
  EXPECT_FALSE(found.is_closed_manifold());
}

TEST(Diagnose, EdgeWithFourTriangles) {
  // two tetrahedra glued along edge 0-1
  TriangleMesh mesh = tetrahedron();
  mesh.vertices.emplace_back(0, -1, 0);
  mesh.vertices.emplace_back(0, 0, -1);
  for (const Triangle& t : {Triangle{0, 4, 1}, Triangle{0, 1, 5}, Triangle{1, 4, 5}, Triangle{0, 5, 4}})
    mesh.triangles.push_back(t);
  const Diagnosis found = diagnose(mesh);
  EXPECT_EQ(found.non_manifold_edges, (Edges{{0, 1}}));
  EXPECT_EQ(found.misoriented_edges, (Edges{{0, 1}, {1, 0}}));
}

TEST(Diagnose, EmptyMeshIsNoSolid) {
  const Diagnosis found = diagnose({});
  EXPECT_FALSE(found.is_closed_manifold());
  EXPECT_EQ(found.components, 0);
}

}  // namespace
}  // namespace rhizodont
