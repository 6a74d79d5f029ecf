// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/border_pieces.hpp"

#include "mesh/geometry.hpp"
#include "mesh/test_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace rhizodont {
namespace {

TEST(BorderPieces, OfAClosedMeshAreNone) { EXPECT_TRUE(border_pieces(test::sphere(2)).empty()); }

TEST(BorderPieces, AreaVectorsSumToTheMeshs) {
  TriangleMesh crown = test::dome(4, 5);
  std::erase_if(crown.triangles, [&](const Triangle& t) {
    return (crown.vertices[static_cast<std::size_t>(t[0])] - Point(3, 0, 4)).norm() < 1;
  });
  const std::vector<BorderPiece> pieces = border_pieces(crown);
  ASSERT_EQ(pieces.size(), 2U);
  EXPECT_LT((pieces[0].area_vector + pieces[1].area_vector - area_vector(crown)).norm(), 1e-9);
  EXPECT_LT(pieces[0].vertices.front(), pieces[1].vertices.front());
  const BorderPiece& base = pieces[base_piece(pieces)];
  EXPECT_GT(base.area_vector.z(), 70);  // the disc of radius 5 has 78.5
  for (const int v : base.vertices) EXPECT_NEAR(crown.vertices[static_cast<std::size_t>(v)].z(), 0, 1e-9);
}

TEST(BorderPieces, ASlitLongerThanTheBaseIsNotTheBase) {
  const TriangleMesh crown = test::slit_dome(5, 5, 1e-3);
  const std::vector<BorderPiece> pieces = border_pieces(crown);
  ASSERT_EQ(pieces.size(), 2U);
  const std::size_t base = base_piece(pieces);
  for (const int v : pieces[base].vertices) EXPECT_NEAR(crown.vertices[static_cast<std::size_t>(v)].z(), 0, 1e-9);
  EXPECT_LT(pieces[1 - base].area_vector.norm(), 0.1);
  const auto length = [&](const BorderPiece& piece) {
    double sum = 0;
    for (const auto& [a, b] : piece.half_edges)
      sum += (crown.vertices[static_cast<std::size_t>(a)] - crown.vertices[static_cast<std::size_t>(b)]).norm();
    return sum;
  };
  EXPECT_GT(length(pieces[1 - base]), 0.8 * length(pieces[base]));
}

TEST(BorderPieces, LoopsThatTouchAreOne) {
  const TriangleMesh bow{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0}, {-1, -1, 0}}, {{0, 1, 2}, {0, 3, 4}}};
  const std::vector<BorderPiece> pieces = border_pieces(bow);
  ASSERT_EQ(pieces.size(), 1U);
  EXPECT_EQ(pieces[0].half_edges.size(), 6U);
  EXPECT_NEAR(pieces[0].area_vector.z(), 1, 1e-12);
}

}  // namespace
}  // namespace rhizodont
