// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "fusion/clear_filling.hpp"

#include "fusion/fill_holes.hpp"
#include "fusion/tiny_patches.hpp"
#include "mesh/adjacency.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace rhizodont {
namespace {

using test::as_set;

/// A box without a lid whose floor is a pyramid with its tip at the height `tip` under the lid's middle: vertices 0-3
/// on the floor, 4-7 the rim, 8 the tip. The rim is higher at its corners 4 and 6: closed over them the lid passes
/// above the level `ridge`, over the others at 1.
TriangleMesh box_with_spike(double tip, double ridge = 1.3) {
  return {
      {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, ridge}, {1, 0, 1}, {1, 1, ridge}, {0, 1, 1}, {0.5, 0.5, tip}},
      {{0, 1, 5},
       {0, 5, 4},
       {1, 2, 6},
       {1, 6, 5},
       {2, 3, 7},
       {2, 7, 6},
       {3, 0, 4},
       {3, 4, 7},
       {1, 0, 8},
       {2, 1, 8},
       {3, 2, 8},
       {0, 3, 8}}};
}

/// The border loop of a mesh with one hole, as new triangles go around.
std::vector<int> only_hole(const TriangleMesh& mesh) {
  const auto loops = border_loops(mesh);
  EXPECT_EQ(loops.size(), 1U);
  std::vector<int> loop(loops.front().begin(), loops.front().end());
  const auto has = [&](int a, int b) {
    return std::any_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const Triangle& t) {
      return (t[0] == a && t[1] == b) || (t[1] == a && t[2] == b) || (t[2] == a && t[0] == b);
    });
  };
  if (has(loop[0], loop[1])) std::reverse(loop.begin(), loop.end());
  return loop;
}

TriangleMesh with(TriangleMesh mesh, const std::vector<Triangle>& triangles) {
  mesh.triangles.insert(mesh.triangles.end(), triangles.begin(), triangles.end());
  return mesh;
}

const std::vector<Triangle> over_the_ridge{{4, 5, 6}, {4, 6, 7}}, through_the_valley{{5, 6, 7}, {5, 7, 4}};

TEST(ClearFilling, TakesTheLidThatBendsLessWhereBothAreClear) {
  const TriangleMesh box = box_with_spike(0.2);
  const auto lid = clear_filling(box, only_hole(box));
  ASSERT_TRUE(lid);
  const auto largest_bend = [&](const std::vector<Triangle>& triangles) {
    double least = 1;
    const TriangleMesh closed = with(box, triangles);
    const std::size_t first = box.triangles.size();
    for (std::size_t t = first; t < closed.triangles.size(); ++t)
      for (std::size_t other = 0; other < closed.triangles.size(); ++other) {
        const Triangle &a = closed.triangles[t], &b = closed.triangles[other];
        const auto shared =
            std::count_if(a.begin(), a.end(), [&](int v) { return std::count(b.begin(), b.end(), v) > 0; });
        if (t != other && shared == 2)
          least = std::min(least, triangle_normal(closed, t).dot(triangle_normal(closed, other)));
      }
    return std::acos(least);
  };
  EXPECT_EQ(as_set(*lid), as_set(largest_bend(over_the_ridge) < largest_bend(through_the_valley) ? over_the_ridge
                                                                                                 : through_the_valley));
}

TEST(ClearFilling, ASpikeThroughTheOneLidLeavesTheOther) {
  // Between the two lids' heights in the middle: the valley's lid is pierced.
  for (const double tip : {1.05, 1.15, 1.25}) {
    const TriangleMesh box = box_with_spike(tip);
    const auto lid = clear_filling(box, only_hole(box));
    ASSERT_TRUE(lid) << tip;
    EXPECT_EQ(as_set(*lid), as_set(over_the_ridge));
    test::expect_ball(with(box, *lid));
  }
}

TEST(ClearFilling, ASpikeThroughBothLidsLeavesNone) {
  const TriangleMesh box = box_with_spike(1.5);
  EXPECT_FALSE(clear_filling(box, only_hole(box)));
}

/// The same with each side of the rim in so many pieces, and the walls below in fans.
TriangleMesh fine_box_with_spike(double tip, int pieces) {
  TriangleMesh box = box_with_spike(tip);
  box.triangles.erase(box.triangles.begin(), box.triangles.begin() + 8);
  std::vector<std::int32_t> rim;
  for (int side = 0; side < 4; ++side) {
    const Point from = box.vertices[static_cast<std::size_t>(4 + side)],
                to = box.vertices[static_cast<std::size_t>(4 + (side + 1) % 4)];
    rim.push_back(4 + side);
    for (int i = 1; i < pieces; ++i) {
      rim.push_back(static_cast<std::int32_t>(box.vertices.size()));
      box.vertices.emplace_back(from + (to - from) * i / pieces);
    }
    const std::size_t first = rim.size() - static_cast<std::size_t>(pieces);
    const std::int32_t below = side, next = (side + 1) % 4;
    box.triangles.push_back({below, next, 4 + (side + 1) % 4});
    for (std::size_t i = first; i + 1 < rim.size(); ++i) box.triangles.push_back({below, rim[i + 1], rim[i]});
    box.triangles.push_back({below, 4 + (side + 1) % 4, rim.back()});
  }
  return box;
}

/// With a small closed body in the middle, that lids over the rim's high corners go through and those over its low ones
/// pass below.
TriangleMesh with_body_above(const TriangleMesh& box) {
  TriangleMesh body = test::tetrahedron();
  const Point middle = (body.vertices[0] + body.vertices[1] + body.vertices[2] + body.vertices[3]) / 4;
  for (Point& p : body.vertices) p = Point(0.5, 0.5, 1.3) + 0.15 * (p - middle);
  return test::together(box, body, {0, 0, 0});
}

TEST(ClearFilling, ALidPassesBelowABodyThatIsInItsWay) {
  const TriangleMesh box = with_body_above(box_with_spike(0.2));
  const auto lid = clear_filling(box, only_hole(box));
  ASSERT_TRUE(lid);
  EXPECT_EQ(as_set(*lid), as_set(through_the_valley));
}

TEST(ClearFilling, FineRimsAreClosedPastABodyToo) {
  for (const int pieces : {5, 14, 24}) {
    const TriangleMesh box = with_body_above(fine_box_with_spike(0.2, pieces));
    ASSERT_TRUE(diagnose(box).is_oriented_manifold());
    ASSERT_FALSE(self_intersecting_triangles(fill_holes(box).mesh).empty()) << "the usual lid is pierced";
    const std::vector<int> hole = only_hole(box);
    EXPECT_EQ(hole.size(), static_cast<std::size_t>(4 * pieces));
    const auto lid = clear_filling(box, hole);
    ASSERT_TRUE(lid) << pieces;
    EXPECT_EQ(lid->size(), hole.size() - 2);
    const TriangleMesh closed = with(box, *lid);
    EXPECT_TRUE(self_intersecting_triangles(closed).empty());
    EXPECT_TRUE(diagnose(closed).is_oriented_manifold());
    EXPECT_TRUE(diagnose(closed).border_edges.empty());
  }
}

TEST(ClearFilling, AnEdgeThatIsThereIsNotTakenTwice) {
  // A tetrahedron's side is missing, cut from corner to corner: of the four-sided hole one diagonal is an edge below.
  const TriangleMesh open{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0.1}, {0, 1, 0}}, {{0, 2, 1}, {0, 3, 2}}};
  const auto lid = clear_filling(open, only_hole(open));
  ASSERT_TRUE(lid);
  EXPECT_EQ(as_set(*lid), as_set({{0, 1, 3}, {1, 2, 3}}));
}

TEST(ClearFilling, AnyHoleOfASphereIsClosedToABall) {
  const TriangleMesh ball = test::sphere(3);
  for (const double radius : {0.25, 0.6, 1.1}) {
    TriangleMesh open = ball;
    std::erase_if(open.triangles, [&](const Triangle& t) {
      return std::any_of(t.begin(), t.end(), [&](int v) {
        return (ball.vertices[static_cast<std::size_t>(v)] - Point(0, 0.6, 0.8)).norm() < radius;
      });
    });
    open = compact(open).mesh;
    const std::vector<int> hole = only_hole(open);
    const auto lid = clear_filling(open, hole);
    ASSERT_TRUE(lid) << radius;
    EXPECT_EQ(lid->size(), hole.size() - 2);
    test::expect_ball(with(open, *lid));
  }
}

TEST(ClearFilling, HolesOfVeryManyVerticesAreLeft) {
  TriangleMesh cone{{{0, 0, 1}}, {}};
  constexpr int around = 300;
  for (int i = 0; i < around; ++i) {
    const double turn = 2 * std::numbers::pi * i / around;
    cone.vertices.emplace_back(std::cos(turn), std::sin(turn), 0);
    cone.triangles.push_back({0, 1 + i, 1 + (i + 1) % around});
  }
  EXPECT_FALSE(clear_filling(cone, only_hole(cone)));
}

TEST(FillHolesClear, AnOrdinaryHoleIsFilledAsEver) {
  const TriangleMesh box = box_with_spike(0.2);
  EXPECT_EQ(fill_holes_clear(box).mesh.triangles, fill_holes(box).mesh.triangles);
  EXPECT_EQ(fill_holes_clear(test::cube()).mesh.triangles, test::cube().triangles);
}

TEST(FillHolesClear, OnlyTheHoleThatIsCutIsFilledAnew) {
  // Two boxes: the one's spike is in the way of a lid, the other's is not; and whichever lid comes by itself, one of
  // the two rims makes it the pierced one.
  for (const bool turned : {false, true}) {
    TriangleMesh pierced = box_with_spike(1.15);
    if (turned)
      for (Point& p : pierced.vertices) p = Point(1 - p.y(), p.x(), p.z());
    const TriangleMesh both = test::together(pierced, box_with_spike(0.2), {3, 0, 0});
    const FilledMesh filled = fill_holes_clear(both);
    EXPECT_EQ(filled.holes, 2);
    EXPECT_TRUE(self_intersecting_triangles(filled.mesh).empty());
    EXPECT_TRUE(diagnose(filled.mesh).is_oriented_manifold());
    EXPECT_EQ(filled.mesh.triangles.size(), both.triangles.size() + 4);
  }
}

TEST(FillHolesClear, WhatCannotBeClearStaysAsItWouldBe) {
  const TriangleMesh box = box_with_spike(1.5);
  EXPECT_EQ(fill_holes_clear(box).mesh.triangles, fill_holes(box).mesh.triangles);
  EXPECT_FALSE(self_intersecting_triangles(fill_holes(box).mesh).empty());
}

}  // namespace
}  // namespace rhizodont
