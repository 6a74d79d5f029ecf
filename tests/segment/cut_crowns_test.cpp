// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "segment/cut_crowns.hpp"

#include "rhizodont/error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <vector>

namespace rhizodont {
namespace {

/// A strip of squares, two triangles each; vertices 2 i and 2 i + 1 are its i-th rung.
TriangleMesh strip(int squares) {
  TriangleMesh mesh;
  for (int i = 0; i <= squares; ++i) {
    mesh.vertices.emplace_back(0.1 * i, 0, 1.0 / 3);
    mesh.vertices.emplace_back(0.1 * i, 1, 0);
  }
  for (int i = 0; i < squares; ++i) {
    mesh.triangles.push_back({2 * i, 2 * i + 2, 2 * i + 1});
    mesh.triangles.push_back({2 * i + 1, 2 * i + 2, 2 * i + 3});
  }
  return mesh;
}

TEST(CutCrowns, TakesTrianglesWhoseCornersAgree) {
  const TriangleMesh mesh = strip(5);
  const std::vector<int> labels{36, 36, 36, 36, 0, 0, 37, 37, 37, 37, 37, 37};
  const auto crowns = cut_crowns(mesh, labels);
  ASSERT_EQ(crowns.size(), 2U);
  EXPECT_EQ(crowns.at(36).old_triangles, (std::vector<int>{0, 1}));
  EXPECT_EQ(crowns.at(37).old_triangles, (std::vector<int>{6, 7, 8, 9}));
  EXPECT_EQ(gum_of(mesh, labels).triangles.size(), 4U);
}

TEST(CutCrowns, KeepsBitsAndOrder) {
  const TriangleMesh mesh = strip(4);
  const auto crown = cut_crowns(mesh, std::vector<int>(mesh.vertices.size(), 11)).at(11);
  ASSERT_EQ(crown.mesh.vertices.size(), mesh.vertices.size());
  EXPECT_EQ(std::memcmp(crown.mesh.vertices.data(), mesh.vertices.data(), mesh.vertices.size() * sizeof(Point)), 0);
  EXPECT_EQ(crown.mesh.triangles, mesh.triangles);
}

TEST(CutCrowns, CrownsAndGumMakeUpTheScanWithoutOverlap) {
  const TriangleMesh mesh = strip(40);
  std::vector<int> labels(mesh.vertices.size());
  for (std::size_t v = 0; v < labels.size(); ++v) labels[v] = std::vector<int>{0, 31, 32}[(v / 7) % 3];
  std::size_t triangles = gum_of(mesh, labels).triangles.size();
  std::vector<int> seen;
  for (const auto& [fdi, crown] : cut_crowns(mesh, labels)) {
    triangles += crown.mesh.triangles.size();
    seen.insert(seen.end(), crown.old_triangles.begin(), crown.old_triangles.end());
  }
  EXPECT_EQ(triangles, mesh.triangles.size());
  std::sort(seen.begin(), seen.end());
  EXPECT_EQ(std::adjacent_find(seen.begin(), seen.end()), seen.end());
}

TEST(CutCrowns, RefusesLabelsOfAnotherLength) {
  EXPECT_THROW(cut_crowns(strip(2), {36, 36}), InputError);
  EXPECT_THROW(gum_of(strip(2), {}), InputError);
}

TEST(CutCrowns, ALabelWithoutATriangleIsNoTooth) {
  const TriangleMesh mesh = strip(2);
  EXPECT_TRUE(cut_crowns(mesh, {36, 0, 0, 36, 0, 0}).empty());
}

}  // namespace
}  // namespace rhizodont
