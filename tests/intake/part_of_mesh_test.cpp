// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "intake/part_of_mesh.hpp"

#include "mesh/adjacency.hpp"
#include "mesh/self_intersection.hpp"
#include "mesh/test_meshes.hpp"
#include "pipeline/product_models.hpp"
#include "rhizodont/complete.hpp"
#include "rhizodont/error.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace rhizodont {
namespace {

using Ids = std::vector<std::int64_t>;

TEST(PartOfMesh, IdsOfErrorsBecomeThoseOfTheWhole) {
  const std::vector<int> vertices{10, 20, 30}, triangles{5, 6};
  const auto ids = [&](const Ids& elements, ElementKind kind) {
    return ids_in_whole(InputError("Wrong.", elements, kind), vertices, triangles);
  };
  EXPECT_EQ(ids({0, 2}, ElementKind::vertices), (Ids{10, 30}));
  EXPECT_EQ(ids({1, 0}, ElementKind::triangles), (Ids{6, 5}));
  EXPECT_EQ(ids({0, 3, 2}, ElementKind::vertices), (Ids{10, 30})) << "vertex 3 is none of the whole";
  EXPECT_EQ(ids({0, 3, 2, 1}, ElementKind::vertex_pairs), (Ids{30, 20})) << "nor is a pair with it";
  EXPECT_EQ(ids({0, 1, 1, 2}, ElementKind::triangle_pairs), (Ids{5, 6}));
  EXPECT_EQ(ids({1}, ElementKind::other), Ids{}) << "a line of a file is no element of a mesh";
}

TEST(PartOfMesh, KindAndCodeOfErrorsStay) {
  try {
    on_part({4, 5}, {}, []() -> int { throw NoResultError("A gap.", {1}, ElementKind::vertices); });
    FAIL() << "nothing was thrown";
  } catch (const NoResultError& error) {
    EXPECT_EQ(error.elements(), Ids{5});
    EXPECT_EQ(error.kind(), ElementKind::vertices);
    EXPECT_STREQ(error.what(), "A gap.");
  }
  EXPECT_EQ(on_part({}, {}, [] { return 7; }), 7);
}

/// Whether each pair that the refusal names cuts itself in the crown as it was given.
void expect_cuts_named(const TriangleMesh& crown, const CompleteOptions& options) {
  try {
    complete_tooth(crown, test::models(), options);
    FAIL() << "nothing was said";
  } catch (const InputError& error) {
    ASSERT_EQ(error.kind(), ElementKind::triangle_pairs) << error.what();
    const auto cuts = self_intersecting_triangles(crown);
    const Ids& ids = error.elements();
    ASSERT_GE(ids.size(), 2U);
    for (std::size_t k = 0; k < ids.size(); k += 2)
      EXPECT_TRUE(std::binary_search(cuts.begin(), cuts.end(),
                                     std::pair(static_cast<int>(ids[k]), static_cast<int>(ids[k + 1]))))
          << ids[k] << " and " << ids[k + 1] << " do not cut each other";
  }
}

/// A bowl 8 mm across whose top is pushed through the wall.
TriangleMesh bowl_that_cuts_itself() {
  TriangleMesh bowl = test::dome(3, 4);
  for (Point& p : bowl.vertices)
    if (p.z() > 3.9) p = Point(6, 0.1, 1);
  return bowl;
}

TEST(PartOfMesh, ARefusedCrownsElementsAreThoseOfTheInput) {
  TriangleMesh speck;
  speck.vertices = {{0, 0, 9}, {0.1, 0, 9}, {0, 0.1, 9}};
  speck.triangles = {{0, 1, 2}};
  expect_cuts_named(test::together(speck, bowl_that_cuts_itself(), Point::Zero()), test::for_tooth(34));
}

TEST(PartOfMesh, ACrownWithoutASurfaceIsNamedSo) {
  TriangleMesh fan{{{0, 0, 0}, {0, 0, 4}, {3, 0, 0}, {0, 3, 0}, {-3, -3, 0}}, {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}}};
  CompleteOptions options = test::for_tooth(34);
  options.skirt = 0.5;
  try {
    complete_tooth(fan, test::models(), options);
    FAIL() << "nothing was said";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("No part of the mesh is a surface"), std::string::npos) << error.what();
  }
}

TEST(PartOfMesh, AClosedCrownsElementsAreThoseOfTheInput) {
  // a flat cap stands first, so that what is kept begins with another number
  TriangleMesh bowl = bowl_that_cuts_itself();
  TriangleMesh capped{bowl.vertices, {}};
  const std::vector<int> rim = border_loops(bowl).front();
  capped.vertices.emplace_back(Point::Zero());
  for (std::size_t i = 0; i < rim.size(); ++i)
    capped.triangles.push_back({rim[(i + 1) % rim.size()], rim[i], static_cast<int>(bowl.vertices.size())});
  capped.triangles.insert(capped.triangles.end(), bowl.triangles.begin(), bowl.triangles.end());
  expect_cuts_named(capped, test::for_tooth(34));
}

}  // namespace
}  // namespace rhizodont
