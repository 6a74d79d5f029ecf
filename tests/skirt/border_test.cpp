// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "skirt/border.hpp"

#include "mesh/test_meshes.hpp"
#include "operators/surfaces.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace rhizodont {
namespace {

TEST(CrownBorder, OfAClosedMeshIsEmpty) {
  const CrownBorder border = crown_border(test::sphere(2));
  EXPECT_TRUE(border.all.empty());
  EXPECT_TRUE(border.outer.empty());
}

TEST(CrownBorder, HolesAreNotItsOuterPart) {
  TriangleMesh sheet = test::rectangle(8, 8, 4, 4);
  const CrownBorder whole = crown_border(sheet);
  EXPECT_EQ(whole.all.size(), 32U);
  EXPECT_EQ(whole.outer, whole.all);
  // A hole around the vertex in the middle.
  const auto middle = std::find_if(sheet.vertices.begin(), sheet.vertices.end(),
                                   [](const Point& p) { return (p - Point(2, 2, 0)).norm() < 1e-9; });
  ASSERT_NE(middle, sheet.vertices.end());
  const int inner = static_cast<int>(middle - sheet.vertices.begin());
  std::erase_if(sheet.triangles,
                [inner](const Triangle& t) { return std::find(t.begin(), t.end(), inner) != t.end(); });
  const CrownBorder pierced = crown_border(sheet);
  EXPECT_EQ(pierced.outer, whole.outer);
  EXPECT_GT(pierced.all.size(), whole.all.size());
  for (const int v : pierced.all) {
    if (std::binary_search(pierced.outer.begin(), pierced.outer.end(), v)) continue;
    EXPECT_LT((sheet.vertices[static_cast<std::size_t>(v)] - Point(2, 2, 0)).norm(), 0.8);
  }
}

}  // namespace
}  // namespace rhizodont
