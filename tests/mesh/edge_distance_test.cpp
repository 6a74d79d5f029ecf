// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/edge_distance.hpp"

#include "mesh/test_meshes.hpp"

#include <gtest/gtest.h>

namespace rhizodont {
namespace {

TEST(EdgeDistance, FollowsEdgesBothWaysAndStopsAtTheLimit) {
  // A strip of four triangles over the points 0 .. 5; 0 2 4 below, 1 3 5 above.
  const TriangleMesh strip{{{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {2, 0, 0}, {2, 1, 0}},
                           {{0, 2, 1}, {2, 3, 1}, {2, 4, 3}, {4, 5, 3}}};
  const std::vector<double> from_end = distances_along_edges(strip, {5});
  EXPECT_DOUBLE_EQ(from_end[3], 1);
  EXPECT_DOUBLE_EQ(from_end[1], 2);
  EXPECT_DOUBLE_EQ(from_end[2], 2);
  EXPECT_DOUBLE_EQ(from_end[0], 3);
  const std::vector<double> near = distances_along_edges(strip, {5}, 1.5);
  EXPECT_DOUBLE_EQ(near[4], 1);
  EXPECT_TRUE(std::isinf(near[1]));
  EXPECT_DOUBLE_EQ(distances_along_edges(strip, {0, 5})[2], 1);
}

TEST(EdgeDistance, IsInfiniteWhereNoWayLeads) {
  TriangleMesh mesh = test::tetrahedron();
  mesh.vertices.emplace_back(3, 3, 3);
  const std::vector<double> distance = distances_along_edges(mesh, {0});
  EXPECT_DOUBLE_EQ(distance[1], 1);
  EXPECT_TRUE(std::isinf(distance[4]));
}

}  // namespace
}  // namespace rhizodont
