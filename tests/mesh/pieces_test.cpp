// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "mesh/pieces.hpp"

#include "mesh/geometry.hpp"
#include "mesh/test_meshes.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace rhizodont {
namespace {

std::string said_of(const TriangleMesh& mesh) { return describe_pieces(mesh, sort_pieces(mesh)); }

/// Adds a triangle of its own.
void add_triangle(TriangleMesh& mesh, const Point& at, double size) {
  mesh.vertices.insert(mesh.vertices.end(), {at, at + Point(size, 0, 0), at + Point(0, size, 0)});
  const auto last = static_cast<std::int32_t>(mesh.vertices.size()) - 1;
  mesh.triangles.push_back({last - 2, last - 1, last});
}

TEST(Pieces, OneIsNothingToSpeakOf) {
  EXPECT_EQ(said_of(test::dome(3, 4)), "");
  EXPECT_TRUE(drop_specks(test::dome(3, 4)).steps.empty());
  EXPECT_TRUE(sort_pieces({}).kinds.empty());
}

TEST(Pieces, SpecksAreSmallOrASingleTriangleWhateverItsArea) {
  TriangleMesh mesh = test::together(test::dome(3, 4), test::dome(0, 0.3), Point(6, 0, 0));
  add_triangle(mesh, Point(0, 9, 0), 12);
  const RepairedMesh rest = drop_specks(mesh);
  EXPECT_EQ(rest.mesh.triangles, test::dome(3, 4).triangles);
  ASSERT_EQ(rest.steps.size(), 1U);
  EXPECT_EQ(rest.steps[0].vertices.size(), mesh.vertices.size() - test::dome(3, 4).vertices.size());
  EXPECT_TRUE(rest.steps[0].triangles.empty());
}

TEST(Pieces, FewTrianglesOfACrownsAreaAreNoSpeck) {
  // a coarse crown beside a fine one
  const TriangleMesh mesh = test::together(test::dome(5, 4), test::dome(0, 4), Point(9, 0, 0));
  EXPECT_TRUE(drop_specks(mesh).steps.empty());
  EXPECT_NE(said_of(mesh).find("2 crowns"), std::string::npos);
}

TEST(Pieces, APatchBehindASeamIsNoSpeckHoweverSmall) {
  const TriangleMesh whole = test::dome(5, 4);
  std::vector<bool> in_patch(whole.triangles.size(), false), rest(whole.triangles.size(), true);
  for (std::size_t t = 0; t < 4; ++t) in_patch[t] = true, rest[t] = false;
  const TriangleMesh patch = submesh(whole, in_patch).mesh, hole = submesh(whole, rest).mesh;
  EXPECT_TRUE(drop_specks(test::together(hole, patch, Point(1e-6, 0, 0))).steps.empty());
  EXPECT_TRUE(drop_specks(test::together(patch, hole, Point(1e-6, 0, 0))).steps.empty());
  EXPECT_FALSE(drop_specks(test::together(hole, patch, Point(0, 0, 3))).steps.empty())
      << "far from its place it is one";
}

TEST(Pieces, ATriangleHangingOnACornerIsASpeckAndTheCornerStays) {
  TriangleMesh mesh = test::dome(3, 4);
  mesh.vertices.emplace_back(5, 5, 0);
  mesh.vertices.emplace_back(6, 5, 0);
  const auto last = static_cast<std::int32_t>(mesh.vertices.size()) - 1;
  mesh.triangles.push_back({0, last - 1, last});
  const RepairedMesh rest = drop_specks(mesh);
  EXPECT_EQ(rest.mesh.vertices, test::dome(3, 4).vertices);
  ASSERT_EQ(rest.steps.size(), 1U);
  EXPECT_EQ(rest.steps[0].vertices, (std::vector<int>{last - 1, last}));
}

TEST(Pieces, ASpeckBetweenVerticesOfTheCrownIsListedAsATriangle) {
  TriangleMesh mesh = test::dome(3, 4);
  mesh.vertices.push_back(Point(mesh.vertices[40]));  // the third corner has the place of a crown's vertex
  mesh.triangles.push_back({0, 20, static_cast<std::int32_t>(mesh.vertices.size()) - 1});
  const RepairedMesh rest = drop_specks(mesh);
  ASSERT_EQ(rest.steps.size(), 1U);
  EXPECT_EQ(rest.steps[0].triangles, std::vector<int>{static_cast<int>(mesh.triangles.size()) - 1});
}

TEST(Pieces, ACrownInShredsHasNoSpecks) {
  TriangleMesh mesh = test::dome(3, 4);
  for (int i = 0; i < 200; ++i) add_triangle(mesh, Point(i, 9, 0), 0.2);
  EXPECT_TRUE(drop_specks(mesh).steps.empty());
  EXPECT_NE(said_of(mesh).find("200 smaller pieces"), std::string::npos);
}

TEST(Pieces, OfLikeSizeAreCrownsOrPartsOfOne) {
  TriangleMesh mesh = test::together(test::dome(3, 4), test::dome(3, 4), Point(9, 0, 0));
  EXPECT_NE(said_of(mesh).find("2 crowns"), std::string::npos);
  for (int i = 2; i < 14; ++i) mesh = test::together(mesh, test::dome(3, 3), Point(9 * i, 0, 0));
  EXPECT_NE(said_of(mesh).find("14 crowns"), std::string::npos);
  // A gap through the middle, as wide as a triangle or three.
  for (const double half_width : {0.05, 0.5}) {
    std::vector<bool> keep;
    const TriangleMesh fine = test::dome(4, 4);
    for (const Triangle& t : fine.triangles) {
      bool beside = false;
      for (const int v : t) beside = beside || std::abs(fine.vertices[static_cast<std::size_t>(v)].x()) < half_width;
      keep.push_back(!beside);
    }
    EXPECT_NE(said_of(submesh(fine, keep).mesh).find("2 halves"), std::string::npos);
  }
}

TEST(Pieces, MeshesThatCannotBeLookedAtComeBackAsTheyAre) {
  TriangleMesh mesh = test::dome(3, 4);
  mesh.triangles.push_back({0, 1, 5000});
  EXPECT_EQ(drop_specks(mesh).mesh.triangles, mesh.triangles);
  mesh = test::together(test::dome(3, 4), test::dome(0, 0.3), Point(6, 0, 0));
  mesh.vertices[0].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(drop_specks(mesh).mesh.triangles, mesh.triangles);
}

}  // namespace
}  // namespace rhizodont
