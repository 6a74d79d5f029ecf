// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "fusion/patch_mesh.hpp"

#include "mesh/adjacency.hpp"
#include "mesh/diagnosis.hpp"
#include "mesh/test_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace rhizodont {
namespace {

/// A hexagon of six triangles: border vertices 0..5 fixed, centre 6 free.
PatchMesh hexagon() {
  std::vector<Point> points;
  for (int i = 0; i < 6; ++i) points.emplace_back(std::cos(i * M_PI / 3), std::sin(i * M_PI / 3), 0);
  points.emplace_back(0, 0, 0);
  std::vector<Triangle> triangles;
  for (int i = 0; i < 6; ++i) triangles.push_back({i, (i + 1) % 6, 6});
  return PatchMesh(points, triangles, 6);
}

int find_half_edge(const PatchMesh& mesh, int a, int b) {
  for (int h = 0; h < mesh.half_edges(); ++h)
    if (mesh.is_alive(h) && mesh.from(h) == a && mesh.to(h) == b) return h;
  return -1;
}

/// The lower part of a sphere with its border vertices numbered first and fixed.
PatchMesh bowl() {
  const TriangleMesh sphere = test::sphere(3, 1);
  std::vector<bool> mask;
  for (const Triangle& t : sphere.triangles)
    mask.push_back(
        std::all_of(t.begin(), t.end(), [&](int v) { return sphere.vertices[static_cast<std::size_t>(v)].z() < 0.4; }));
  const TriangleMesh part = submesh(sphere, mask).mesh;
  const std::vector<int> border = border_loops(part).front();
  std::vector<int> number(part.vertices.size(), -1);
  std::vector<Point> points;
  const auto give = [&](int v) {
    number[static_cast<std::size_t>(v)] = static_cast<int>(points.size());
    points.push_back(part.vertices[static_cast<std::size_t>(v)]);
  };
  for (const int v : border) give(v);
  for (std::size_t v = 0; v < number.size(); ++v)
    if (number[v] < 0) give(static_cast<int>(v));
  std::vector<Triangle> triangles = part.triangles;
  for (Triangle& t : triangles)
    for (std::int32_t& v : t) v = number[static_cast<std::size_t>(v)];
  return PatchMesh(points, triangles, static_cast<int>(border.size()));
}

void expect_disc(const PatchMesh& mesh, const std::vector<int>& border) {
  const TriangleMesh result = compact({mesh.points, mesh.triangles()}).mesh;
  const Diagnosis found = diagnose(result);
  EXPECT_TRUE(found.non_manifold_edges.empty());
  EXPECT_TRUE(found.misoriented_edges.empty());
  EXPECT_TRUE(found.non_manifold_vertices.empty());
  EXPECT_EQ(found.euler_number, 1);
  EXPECT_EQ(border_loops({mesh.points, mesh.triangles()}).front(), border);
}

TEST(PatchMesh, NeighboursOfCentreAndBorder) {
  const PatchMesh mesh = hexagon();
  EXPECT_EQ(mesh.neighbours(6).size(), 6U);
  std::vector<int> of_corner = mesh.neighbours(0);
  std::sort(of_corner.begin(), of_corner.end());
  EXPECT_EQ(of_corner, (std::vector<int>{1, 5, 6}));
}

TEST(PatchMesh, NoNewEdgeBetweenFixedVertices) {
  const PatchMesh mesh = hexagon();
  EXPECT_FALSE(mesh.can_flip(find_half_edge(mesh, 0, 6)));      // would join 1 and 5
  EXPECT_FALSE(mesh.can_collapse(find_half_edge(mesh, 6, 0)));  // would join 0 with 2, 3 and 4
  EXPECT_FALSE(mesh.can_collapse(find_half_edge(mesh, 0, 6)));  // would move a fixed vertex
}

TEST(PatchMesh, SplitAndCollapseComeBackToTheSameTriangles) {
  PatchMesh mesh = hexagon();
  const auto sorted = [](std::vector<Triangle> triangles) {
    for (Triangle& t : triangles) std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    std::sort(triangles.begin(), triangles.end());
    return triangles;
  };
  const auto before = sorted(mesh.triangles());
  const int m = mesh.split(find_half_edge(mesh, 6, 0), {0.5, 0, 0});
  EXPECT_EQ(mesh.triangles().size(), 8U);
  EXPECT_EQ(mesh.neighbours(m).size(), 4U);
  const int back = find_half_edge(mesh, m, 6);
  ASSERT_TRUE(mesh.can_collapse(back));
  mesh.collapse(back);
  EXPECT_EQ(sorted(mesh.triangles()), before);
}

TEST(PatchMesh, AnyOperationsLeaveADiscWithTheSameBorder) {
  PatchMesh mesh = bowl();
  const std::vector<int> border = border_loops({mesh.points, mesh.triangles()}).front();
  std::mt19937 random(5);
  int flips = 0, splits = 0, collapses = 0;
  for (int i = 0; i < 4000; ++i) {
    const int h = static_cast<int>(random() % static_cast<unsigned>(mesh.half_edges()));
    if (!mesh.is_alive(h)) continue;
    switch (random() % 3) {
      case 0:
        if (mesh.can_flip(h)) mesh.flip(h), ++flips;
        break;
      case 1:
        if (mesh.opposite(h) >= 0)
          mesh.split(h, 0.5 * (mesh.points[static_cast<std::size_t>(mesh.from(h))] +
                               mesh.points[static_cast<std::size_t>(mesh.to(h))])),
              ++splits;
        break;
      default:
        if (mesh.can_collapse(h)) mesh.collapse(h), ++collapses;
    }
  }
  EXPECT_GT(std::min({flips, splits, collapses}), 200);
  expect_disc(mesh, border);
}

}  // namespace
}  // namespace rhizodont
