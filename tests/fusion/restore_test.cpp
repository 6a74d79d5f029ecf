// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Duals of a few triangles, as they come and as they should not: what becomes of them is known to the triangle.

#include "fusion/restore.hpp"

#include "fusion/tiny_patches.hpp"
#include "rhizodont/error.hpp"

namespace rhizodont {
namespace {

using test::as_places;
using test::as_set;
using test::lower_half;
using test::pyramid;

/// The crown and root sites, not joined yet.
Joining sites_of(const TriangleMesh& crown, const std::vector<Point>& root) {
  Joining joining;
  joining.sites = crown.vertices;
  joining.sites.insert(joining.sites.end(), root.begin(), root.end());
  joining.crown_vertices = static_cast<int>(crown.vertices.size());
  return joining;
}

/// The pyramid on a root of one vertex: together the octahedron. The dual has the crown's triangles, too.
Joining octahedron_dual() {
  Joining joining = sites_of(pyramid(), {{0, 0, -1}});
  joining.triangles = pyramid().triangles;
  for (const Triangle& t : lower_half(5)) joining.triangles.push_back(t);
  joining.crown_triangles_direct = 4;
  return joining;
}

std::vector<Triangle> octahedron_triangles() {
  std::vector<Triangle> all = pyramid().triangles;
  for (const Triangle& t : lower_half(5)) all.push_back(t);
  return as_set(all);
}

void expect_octahedron(const JoinedTooth& tooth, int filled) {
  test::expect_crown_kept(pyramid(), tooth);
  test::expect_ball(tooth.mesh);
  EXPECT_EQ(tooth.mesh.vertices.size(), 6U);
  EXPECT_EQ(as_set(tooth.mesh.triangles), octahedron_triangles());
  EXPECT_EQ(tooth.triangles_filled, filled);
  EXPECT_EQ(tooth.holes_filled, filled > 0 ? 1 : 0);
}

TEST(Restore, AWholeDualIsTakenAsItIs) {
  const JoinedTooth tooth = restore_crown(pyramid(), octahedron_dual());
  expect_octahedron(tooth, 0);
  EXPECT_EQ(tooth.triangles_brought_back, 0);
}

TEST(Restore, CrownTrianglesThatTheDualLacksAreBroughtBack) {
  Joining joining = octahedron_dual();
  joining.triangles.erase(joining.triangles.begin(), joining.triangles.begin() + 3);
  joining.crown_triangles_direct = 1;
  const JoinedTooth tooth = restore_crown(pyramid(), joining);
  expect_octahedron(tooth, 0);
  EXPECT_EQ(tooth.triangles_brought_back, 3);
}

TEST(Restore, GapsInTheDualAreFilled) {
  for (std::size_t missing = 1; missing <= 3; ++missing) {
    SCOPED_TRACE(missing);
    Joining joining = octahedron_dual();
    joining.triangles.resize(joining.triangles.size() - missing);
    // With three missing the gap has five vertices, and again the octahedron bends least.
    expect_octahedron(restore_crown(pyramid(), joining), static_cast<int>(missing));
  }
}

TEST(Restore, ATriangleThatStandsTwiceIsTakenBackAndTheGapFilled) {
  Joining joining = octahedron_dual();
  joining.triangles.push_back(joining.triangles.back());
  expect_octahedron(restore_crown(pyramid(), joining), 1);
}

TEST(Restore, ATriangleOverAnEdgeOfTheCrownFromTheCrownsSideIsLeftOut) {
  Joining joining = octahedron_dual();
  joining.triangles.push_back({0, 1, 5});  // runs along 0 -> 1 as the crown does
  expect_octahedron(restore_crown(pyramid(), joining), 0);
}

TEST(Restore, ATriangleAtAnInnerVertexOfTheCrownIsLeftOut) {
  Joining joining = octahedron_dual();
  joining.triangles.push_back({2, 4, 5});
  expect_octahedron(restore_crown(pyramid(), joining), 0);
}

TEST(Restore, NothingOfSteinerPointsIsLeft) {
  Joining joining = sites_of(pyramid(), {{0.5, 0, 0.5}, {0, 0, -1}});  // on edge 0-4, and the root
  joining.steiner_points = 1;
  joining.triangles = lower_half(6);
  joining.triangles[0] = {1, 0, 5};
  joining.triangles.push_back({0, 6, 5});
  joining.triangles.push_back({6, 1, 5});
  const JoinedTooth tooth = restore_crown(pyramid(), joining);
  expect_octahedron(tooth, 1);
  EXPECT_EQ(tooth.triangles_brought_back, 4);
}

TEST(Restore, WhatHangsBesideTheRootGoesAndItsSitesWithIt) {
  Joining joining = sites_of(pyramid(), {{9, 0, 0}, {9, 1, 0}, {8, 0, 1}, {0, 0, -1}});
  joining.triangles = {{5, 6, 7}};
  for (const Triangle& t : lower_half(8)) joining.triangles.push_back(t);
  expect_octahedron(restore_crown(pyramid(), joining), 0);
}

TEST(Restore, TheOrderOfTheDualDoesNotMatter) {
  Joining joining = octahedron_dual();
  joining.triangles.pop_back();
  std::vector<Triangle> order = joining.triangles;
  std::sort(order.begin(), order.end());
  do {
    joining.triangles = order;
    expect_octahedron(restore_crown(pyramid(), joining), 1);
  } while (std::next_permutation(order.begin() + 3, order.end()));
}

TEST(Restore, OfPartsThatMeetInAVertexOneIsKept) {
  Joining joining = octahedron_dual();
  joining.triangles = {lower_half(5)[0], lower_half(5)[2]};
  expect_octahedron(restore_crown(pyramid(), joining), 3);
}

TEST(Restore, ADualWithoutARootIsRefused) {
  Joining joining = octahedron_dual();
  joining.triangles = pyramid().triangles;
  try {
    restore_crown(pyramid(), joining);
    FAIL() << "was joined";
  } catch (const NoResultError& error) {
    EXPECT_STREQ(error.what(), "The predicted root and the crown do not meet.");
  }
}

TEST(Restore, ARootThatDoesNotReachTheCrownIsBridgedOver) {
  // A pyramid upside down with its border 1 under the crown's: two triangles for the bridge, six for the ring about it.
  Joining joining = sites_of(pyramid(), {{1, 0, -1}, {0, 1, -1}, {-1, 0, -1}, {0, -1, -1}, {0, 0, -2}});
  for (const Triangle& t : lower_half(9)) joining.triangles.push_back(t);
  for (Triangle& t : joining.triangles)
    for (std::int32_t& v : t)
      if (v < 4) v += 5;
  const JoinedTooth tooth = restore_crown(pyramid(), joining);
  test::expect_crown_kept(pyramid(), tooth);
  test::expect_ball(tooth.mesh);
  EXPECT_EQ(tooth.mesh.vertices.size(), 10U);
  EXPECT_EQ(tooth.mesh.triangles.size(), 16U) << "2 V - 4";
  EXPECT_EQ(tooth.triangles_filled, 6);
  EXPECT_EQ(tooth.holes_filled, 1);
  EXPECT_NEAR(volume(tooth.mesh), 2.0 * 1 + 2 * (2.0 / 3), 0.4) << "a square prism of side sqrt 2 and two pyramids";
}

/// A ball of 512 triangles: its upper half the crown, the lower vertices the root.
struct Ball {
  TriangleMesh crown = test::dome(3);
  TriangleMesh whole;
  Joining joining;

  Ball() {
    const TriangleMesh ball = test::sphere(3);
    std::vector<Point> root;
    for (const Point& p : ball.vertices)
      if (p.z() < -1e-9) root.push_back(p);
    joining = sites_of(crown, root);
    const auto site = [&](const Point& p) {
      const auto found = std::find(joining.sites.begin(), joining.sites.end(), p);
      return static_cast<std::int32_t>(found - joining.sites.begin());
    };
    whole.vertices = joining.sites;
    for (const Triangle& t : ball.triangles) {
      Triangle now{};
      for (std::size_t i = 0; i < 3; ++i) now[i] = site(ball.vertices[static_cast<std::size_t>(t[i])]);
      whole.triangles.push_back(now);
    }
    joining.triangles = whole.triangles;
  }
};

TEST(Restore, AHoleOfTheCrownIsFilledAndNoRootGrowsIntoIt) {
  Ball ball;
  const auto reaching = [&](std::vector<Triangle>& triangles, const std::vector<Point>& points, double up) {
    const auto found = std::find_if(triangles.begin(), triangles.end(), [&](const Triangle& t) {
      return std::all_of(t.begin(), t.end(), [&](int v) { return up * points[static_cast<std::size_t>(v)].z() > 0.8; });
    });
    const Triangle taken = *found;
    triangles.erase(found);
    return taken;
  };
  // A dual with a tube from the crown's hole to one in the root, six triangles around.
  const auto [a, b, c] = reaching(ball.crown.triangles, ball.crown.vertices, 1);
  const auto [p, q, r] = reaching(ball.joining.triangles, ball.joining.sites, -1);
  for (const Triangle& t : {Triangle{a, b, p}, {b, r, p}, {b, c, r}, {c, q, r}, {c, a, q}, {a, p, q}})
    ball.joining.triangles.push_back(t);
  const JoinedTooth tooth = restore_crown(ball.crown, ball.joining);
  test::expect_crown_kept(ball.crown, tooth);
  EXPECT_EQ(tooth.holes_filled, 2);
  EXPECT_EQ(as_places(tooth.mesh), as_places(ball.whole));
}

TEST(Restore, AVertexWhereTwoGapsMeetGoes) {
  Ball ball;
  const std::int32_t apex = ball.joining.crown_vertices;  // any of the root that lies off the border
  const auto around = [&](const Triangle& t) { return std::count(t.begin(), t.end(), apex) > 0; };
  std::vector<Triangle> star;
  std::copy_if(ball.whole.triangles.begin(), ball.whole.triangles.end(), std::back_inserter(star), around);
  ASSERT_GE(star.size(), 4U);
  // Two of its triangles that have no edge in common.
  const auto apart = std::find_if(star.begin() + 1, star.end(), [&](const Triangle& t) {
    return std::count_if(t.begin(), t.end(),
                         [&](int v) { return std::count(star[0].begin(), star[0].end(), v) > 0; }) == 1;
  });
  ASSERT_NE(apart, star.end());
  std::erase_if(ball.joining.triangles, [&](const Triangle& t) { return t == star[0] || t == *apart; });
  const JoinedTooth tooth = restore_crown(ball.crown, ball.joining);
  test::expect_crown_kept(ball.crown, tooth);
  test::expect_ball(tooth.mesh);
  EXPECT_EQ(tooth.mesh.vertices.size(), ball.whole.vertices.size() - 1);
  EXPECT_EQ(tooth.triangles_filled, static_cast<int>(star.size()) - 2);
  EXPECT_EQ(tooth.holes_filled, 1);
}

TEST(Restore, ARootThatCutsTheCrownIsTakenBackThere) {
  Ball ball;
  // One vertex of the root, beside the border, far up: its triangles go through the crown's side.
  auto bent = std::find_if(ball.joining.sites.begin() + ball.joining.crown_vertices, ball.joining.sites.end(),
                           [](const Point& p) { return p.z() > -0.25 && p.x() > 0.5 && p.y() > 0.5; });
  ASSERT_NE(bent, ball.joining.sites.end());
  *bent = Point(-0.9, -0.9, 0.9);
  RestoreOptions impatient;
  impatient.rounds = 0;
  try {
    restore_crown(ball.crown, ball.joining, impatient);
    FAIL() << "cuts itself";
  } catch (const NoResultError& error) {
    EXPECT_EQ(error.kind(), ElementKind::triangles);
    EXPECT_FALSE(error.elements().empty());
    EXPECT_TRUE(std::is_sorted(error.elements().begin(), error.elements().end()));
    EXPECT_LT(error.elements().back(), static_cast<std::int64_t>(ball.crown.triangles.size()));
  }
  const JoinedTooth tooth = restore_crown(ball.crown, ball.joining);
  test::expect_crown_kept(ball.crown, tooth);
  test::expect_ball(tooth.mesh);
  EXPECT_EQ(std::count(tooth.mesh.vertices.begin(), tooth.mesh.vertices.end(), *bent), 0);
  EXPECT_EQ(tooth.holes_filled, 1);
  EXPECT_LT(tooth.mesh.vertices.size(), ball.whole.vertices.size());
}

TEST(Restore, MovedOrMirroredTheToothIsTheSame) {
  Ball ball;
  ball.joining.triangles.erase(
      std::remove_if(
          ball.joining.triangles.begin(), ball.joining.triangles.end(),
          [&](const Triangle& t) { return std::count(t.begin(), t.end(), ball.joining.crown_vertices + 2) > 0; }),
      ball.joining.triangles.end());
  const JoinedTooth tooth = restore_crown(ball.crown, ball.joining);
  test::expect_ball(tooth.mesh);
  EXPECT_EQ(tooth.holes_filled, 1);
  const test::Motion motion;
  Joining moved = ball.joining;
  for (Point& p : moved.sites) p = motion(p);
  EXPECT_EQ(restore_crown(motion(ball.crown), moved).mesh.vertices.size(), tooth.mesh.vertices.size());
  EXPECT_EQ(as_places(restore_crown(motion(ball.crown), moved).mesh).size(), tooth.mesh.triangles.size());
  EXPECT_NEAR(volume(restore_crown(motion(ball.crown), moved).mesh), volume(tooth.mesh), 1e-9);
  Joining in_mirror = ball.joining;
  in_mirror.triangles = test::mirrored(in_mirror.triangles);
  for (Point& p : in_mirror.sites) p.x() = -p.x();
  EXPECT_NEAR(volume(restore_crown(test::mirrored(ball.crown), in_mirror).mesh), volume(tooth.mesh), 1e-9);
}

TEST(Restore, OptionsOutOfRange) {
  RestoreOptions options;
  options.rounds = -1;
  EXPECT_THROW(restore_crown(pyramid(), octahedron_dual(), options), UsageError);
}

}  // namespace
}  // namespace rhizodont
