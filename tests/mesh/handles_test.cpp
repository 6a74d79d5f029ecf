// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/handles.hpp"

#include "mesh/test_meshes.hpp"

#include <gtest/gtest.h>

namespace rhizodont {
namespace {

TriangleMesh without(TriangleMesh mesh, std::size_t first, std::size_t count) {
  mesh.triangles.erase(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(first),
                       mesh.triangles.begin() + static_cast<std::ptrdiff_t>(first + count));
  return mesh;
}

TriangleMesh both(TriangleMesh a, const TriangleMesh& b) {
  const auto shift = static_cast<std::int32_t>(a.vertices.size());
  for (const Point& p : b.vertices) a.vertices.push_back(p + Point(10, 0, 0));
  for (const Triangle& t : b.triangles) a.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
  return a;
}

TEST(Handles, OfSpheresDiscsAndRingsAreNone) {
  EXPECT_EQ(handle_count(TriangleMesh{}), 0);
  EXPECT_EQ(handle_count(test::sphere(2)), 0);
  EXPECT_EQ(handle_count(test::dome(3)), 0);
  EXPECT_EQ(handle_count(without(without(test::sphere(3), 200, 1), 0, 1)), 0);
}

TEST(Handles, AreCountedWithAndWithoutBorders) {
  const TriangleMesh ring = test::torus(12, 8);
  EXPECT_EQ(handle_count(ring), 1);
  EXPECT_EQ(handle_count(without(ring, 0, 1)), 1);
  EXPECT_EQ(handle_count(without(without(ring, 90, 3), 0, 1)), 1);
  EXPECT_EQ(handle_count(both(ring, ring)), 2);
  EXPECT_EQ(handle_count(both(ring, test::sphere(1))), 1);
}

TEST(Handles, FansThatOnlyTouchJoinNothing) {
  // Two triangles far apart on a sphere taken out, and a vertex of one border put in the place of one of the other's.
  TriangleMesh mesh = without(without(test::sphere(3), 200, 1), 0, 1);
  const Triangle a = test::sphere(3).triangles[0], b = test::sphere(3).triangles[200];
  for (Triangle& t : mesh.triangles)
    for (std::int32_t& v : t)
      if (v == b[0]) v = a[0];
  EXPECT_EQ(handle_count(mesh), 0);
}

}  // namespace
}  // namespace rhizodont
