// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "skirt/skirt.hpp"

#include "mesh/adjacency.hpp"
#include "mesh/test_meshes.hpp"
#include "rhizodont/error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace rhizodont {
namespace {

std::set<int> dropped_for(const KeptCrown& kept, DropReason reason) {
  std::set<int> vertices;
  for (const DroppedCrownVertex& d : kept.dropped)
    if (d.reason == reason) vertices.insert(d.vertex);
  return vertices;
}

/// Every triangle between kept vertices is kept, and the border is made of simple loops.
void expect_whole(const TriangleMesh& input, const KeptCrown& kept) {
  const std::set<int> vertices(kept.old_vertices.begin(), kept.old_vertices.end());
  std::size_t between = 0;
  for (const Triangle& t : input.triangles)
    between += std::all_of(t.begin(), t.end(), [&](int v) { return vertices.contains(v); });
  EXPECT_EQ(between, kept.mesh.triangles.size());
  EXPECT_NO_THROW(border_loops(kept.mesh));
  EXPECT_EQ(connected_components(kept.mesh).count, 1);
  EXPECT_EQ(kept.old_vertices.size() + kept.dropped.size(), input.vertices.size());
}

TEST(Skirt, KeepsAGoodCrownWhole) {
  TriangleMesh mesh = test::grid(4);
  mesh.vertices.emplace_back(9, 9, 9);
  const KeptCrown kept = keep_crown(mesh, std::vector<bool>(mesh.triangles.size(), true), DropReason::cap);
  expect_whole(mesh, kept);
  EXPECT_EQ(kept.mesh.triangles, mesh.triangles);
  EXPECT_EQ(dropped_for(kept, DropReason::unreferenced), (std::set<int>{25}));
  EXPECT_EQ(kept.dropped.size(), 1U);
}

TEST(Skirt, ATriangleBetweenKeptVerticesComesBack) {
  const TriangleMesh mesh = test::grid(4);
  std::vector<bool> keep(mesh.triangles.size(), true);
  keep[10] = false;  // all its vertices are in neighbours that stay
  const KeptCrown kept = keep_crown(mesh, keep, DropReason::cap);
  expect_whole(mesh, kept);
  EXPECT_EQ(kept.mesh.triangles.size(), mesh.triangles.size());
}

TEST(Skirt, TwoPartsHangingTogetherByAVertexLoseTheSmallerOne) {
  // Two grids that share one corner: the border passes that vertex twice.
  TriangleMesh mesh = test::together(test::grid(4), test::grid(2), Point(4, 4, 0));
  for (Triangle& t : mesh.triangles)
    for (std::int32_t& v : t)
      if (v == 25) v = 24;
  const KeptCrown kept = keep_crown(mesh, std::vector<bool>(mesh.triangles.size(), true), DropReason::cap);
  expect_whole(mesh, kept);
  EXPECT_EQ(kept.mesh.triangles.size(), test::grid(4).triangles.size());
  EXPECT_EQ(dropped_for(kept, DropReason::pinched_border).size(), 8U);
  EXPECT_FALSE(dropped_for(kept, DropReason::pinched_border).contains(24))
      << "without the smaller part the vertex is sound";
}

TEST(Skirt, AVertexThatTheBorderPassesTwiceGoes) {
  // Two opposite quads around an inner vertex are taken out: the border meets itself there.
  const TriangleMesh mesh = test::grid(4);
  TriangleMesh open = mesh;
  std::erase_if(open.triangles, [](const Triangle& t) {
    const auto in = [&](std::set<int> quad) {
      return std::all_of(t.begin(), t.end(), [&](int v) { return quad.contains(v); });
    };
    return in({6, 7, 11, 12}) || in({12, 13, 17, 18});
  });
  const KeptCrown kept = keep_crown(open, std::vector<bool>(open.triangles.size(), true), DropReason::cap);
  expect_whole(open, kept);
  EXPECT_TRUE(dropped_for(kept, DropReason::pinched_border).contains(12));
}

TEST(Skirt, MaskedVerticesAreNamedWithTheReason) {
  const TriangleMesh mesh = test::grid(3);
  std::vector<bool> keep;
  for (const Triangle& t : mesh.triangles)
    keep.push_back(
        std::all_of(t.begin(), t.end(), [&](int v) { return mesh.vertices[static_cast<std::size_t>(v)].y() >= 1; }));
  const KeptCrown kept = keep_crown(mesh, keep, DropReason::cap);
  expect_whole(mesh, kept);
  EXPECT_EQ(dropped_for(kept, DropReason::cap), (std::set<int>{0, 1, 2, 3}));
}

TEST(Skirt, NothingLeftIsAnError) {
  const TriangleMesh mesh = test::grid(2);
  EXPECT_THROW(keep_crown(mesh, std::vector<bool>(mesh.triangles.size(), false), DropReason::cap), InputError);
}

}  // namespace
}  // namespace rhizodont
