// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "fusion/transition.hpp"
#include "fusion/fuse.hpp"
#include "mesh/adjacency.hpp"
#include "mesh/geometry.hpp"
#include "mesh/test_meshes.hpp"
#include "teeth/prepared_crown.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace rhizodont {
namespace {

/// A strip of a plane: the crown is the part y >= 0, its vertices and triangles come first.
JoinedTooth plane(double bump) {
  constexpr int width = 12, depth = 16, crown_rows = 6;
  JoinedTooth tooth;
  for (int row = 0; row < depth; ++row)
    for (int x = 0; x < width; ++x)
      tooth.mesh.vertices.emplace_back(0.3 * x + 0.15 * (row % 2), 0.26 * (crown_rows - 1 - row),
                                       row == crown_rows + 1 && x == width / 2 ? bump : 0.0);
  for (int row = 0; row + 1 < depth; ++row) {
    for (int x = 0; x + 1 < width; ++x) {
      const int a = row * width + x, c = a + width;
      if (row % 2 == 0) {
        tooth.mesh.triangles.push_back({a, c, a + 1});
        tooth.mesh.triangles.push_back({a + 1, c, c + 1});
      } else {
        tooth.mesh.triangles.push_back({a, c, c + 1});
        tooth.mesh.triangles.push_back({a, c + 1, a + 1});
      }
    }
    if (row == crown_rows - 2) tooth.crown_triangles = static_cast<int>(tooth.mesh.triangles.size());
  }
  tooth.crown_vertices = crown_rows * width;
  return tooth;
}

TEST(Transition, PlaneStaysAPlane) {
  JoinedTooth tooth = plane(0);
  TransitionOptions options;
  options.width = 1;
  const Transition done = smooth_transition(tooth, options);
  EXPECT_FALSE(done.vertices.empty());
  EXPECT_FALSE(done.cuts_itself);
  for (const Point& p : tooth.mesh.vertices) EXPECT_NEAR(p.z(), 0, 1e-12);
}

TEST(Transition, BumpInAPlaneIsHealedAndTheCrownStays) {
  const JoinedTooth before = plane(0.2);
  JoinedTooth tooth = before;
  TransitionOptions options;
  options.width = 1;
  const Transition done = smooth_transition(tooth, options);
  EXPECT_GT(done.applied, 0.9);  // at the strip's open sides some vertices are held back
  EXPECT_NEAR(done.largest_move, 0.2, 0.03);
  for (const Point& p : tooth.mesh.vertices) EXPECT_NEAR(p.z(), 0, 1e-9);
  for (int v = 0; v < tooth.crown_vertices; ++v)
    EXPECT_EQ(tooth.mesh.vertices[static_cast<std::size_t>(v)], before.mesh.vertices[static_cast<std::size_t>(v)]);
}

TEST(Transition, WidthFollowsTheGap) {
  JoinedTooth tooth = plane(0);
  TransitionOptions options;
  const double without_gap = smooth_transition(tooth, options).width;
  EXPECT_NEAR(without_gap, 0.9, 0.1);  // three rows of edges of 0.3 mm
  options.gap = 0.3;
  EXPECT_NEAR(smooth_transition(tooth, options).width, 2, 1e-9);  // 0.3 mm at a slope of 0.15
  options.width = 0;
  EXPECT_TRUE(smooth_transition(tooth, options).vertices.empty());
}

/// Angles in degrees between the normals of the two triangles at each edge of the crown's border.
std::vector<double> bends_at_border(const JoinedTooth& tooth) {
  const TriangleAdjacency adjacency = triangle_adjacency(tooth.mesh);
  std::vector<double> bends;
  for (int t = 0; t < tooth.crown_triangles; ++t)
    for (const int n : adjacency.neighbours[static_cast<std::size_t>(t)]) {
      if (n < tooth.crown_triangles) continue;
      const double cosine = triangle_normal(tooth.mesh, static_cast<std::size_t>(t))
                                .dot(triangle_normal(tooth.mesh, static_cast<std::size_t>(n)));
      bends.push_back(std::acos(std::clamp(cosine, -1.0, 1.0)) * 180 / M_PI);
    }
  std::sort(bends.begin(), bends.end());
  return bends;
}

TEST(Transition, SlopeContinuesOverTheBorderOfASphere) {
  // The upper half of a ball of radius 5 on a root that is 0.15 mm thicker.
  const TriangleMesh sphere = test::sphere(4, 5);
  std::vector<bool> mask;
  for (const Triangle& t : sphere.triangles)
    mask.push_back(
        std::all_of(t.begin(), t.end(), [&](int v) { return sphere.vertices[static_cast<std::size_t>(v)].z() > 0; }));
  const TriangleMesh crown = submesh(sphere, mask).mesh;
  FuseOptions options;
  options.transition.width = 0;
  const auto before = bends_at_border(
      fuse_crown_and_root(prepare_crown(crown), test::sphere(5, 5.15), Eigen::Vector3d::UnitZ(), options).tooth);
  options.transition.width.reset();
  const FusedTooth fused =
      fuse_crown_and_root(prepare_crown(crown), test::sphere(5, 5.15), Eigen::Vector3d::UnitZ(), options);
  const auto after = bends_at_border(fused.tooth);
  EXPECT_EQ(fused.transition.applied, 1);
  // Neighbouring triangles of a sphere of this size and fineness bend by up to 5 degrees.
  EXPECT_GT(before[before.size() / 2], 9);
  EXPECT_LT(after[after.size() / 2], 5);
  EXPECT_LT(after[after.size() * 9 / 10], 9);
}

}  // namespace
}  // namespace rhizodont
