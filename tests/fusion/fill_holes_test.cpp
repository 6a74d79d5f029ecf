// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "fusion/fill_holes.hpp"

#include "fusion/tiny_patches.hpp"
#include "mesh/adjacency.hpp"
#include "rhizodont/error.hpp"

#include <cmath>
#include <numbers>

namespace rhizodont {
namespace {

using test::as_set;

std::vector<Triangle> added(const TriangleMesh& before, const FilledMesh& filled) {
  EXPECT_EQ(filled.mesh.vertices, before.vertices) << "no vertex is added or moved";
  EXPECT_TRUE(std::equal(before.triangles.begin(), before.triangles.end(), filled.mesh.triangles.begin()));
  return {filled.mesh.triangles.begin() + static_cast<std::ptrdiff_t>(before.triangles.size()),
          filled.mesh.triangles.end()};
}

/// Without the triangles of the given numbers.
TriangleMesh without(TriangleMesh mesh, const std::vector<std::size_t>& triangles) {
  for (auto t = triangles.rbegin(); t != triangles.rend(); ++t)
    mesh.triangles.erase(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(*t));
  return mesh;
}

TriangleMesh octahedron() { return test::sphere(0); }

TEST(FillHoles, AClosedMeshStaysAsItIs) {
  const FilledMesh filled = fill_holes(test::cube());
  EXPECT_EQ(filled.holes, 0);
  EXPECT_EQ(filled.mesh.vertices, test::cube().vertices);
  EXPECT_EQ(filled.mesh.triangles, test::cube().triangles);
}

TEST(FillHoles, AMissingTriangleIsPutBack) {
  for (std::size_t t = 0; t < 8; ++t) {
    const TriangleMesh open = without(octahedron(), {t});
    const FilledMesh filled = fill_holes(open);
    EXPECT_EQ(filled.holes, 1);
    EXPECT_EQ(as_set(added(open, filled)), as_set({octahedron().triangles[t]}));
  }
}

TEST(FillHoles, TwoNeighboursComeBackAsTheyBendLeast) {
  // Over the other diagonal, through the middle, neighbours would bend by 125 degrees instead of 71.
  const TriangleMesh open = without(octahedron(), {4, 5});
  EXPECT_EQ(as_set(fill_holes(open).mesh.triangles), as_set(octahedron().triangles));
}

TEST(FillHoles, TheOpenSideOfACubeIsFlat) {
  const TriangleMesh open = without(test::cube(), {2, 3});
  const FilledMesh filled = fill_holes(open);
  EXPECT_EQ(added(open, filled).size(), 2U);
  test::expect_ball(filled.mesh);
  EXPECT_NEAR(volume(filled.mesh), 1, 1e-12);
}

TEST(FillHoles, EachHoleOfNVerticesGetsNMinusTwoTriangles) {
  const TriangleMesh ball = test::sphere(3);
  const std::vector<Point> centres{{1, 0, 0}, {0, 0, 1}, {-0.6, -0.6, -0.5}, {0, 1, 0}};
  TriangleMesh open = ball;
  std::erase_if(open.triangles, [&](const Triangle& t) {
    return std::any_of(t.begin(), t.end(), [&](int v) {
      return std::any_of(centres.begin(), centres.end(), [&](const Point& c) {
        return (ball.vertices[static_cast<std::size_t>(v)] - c.normalized()).norm() < 0.3;
      });
    });
  });
  open = compact(open).mesh;
  std::size_t expected = 0;
  for (const auto& loop : border_loops(open)) expected += loop.size() - 2;
  const FilledMesh filled = fill_holes(open);
  EXPECT_EQ(filled.holes, 4);
  EXPECT_EQ(added(open, filled).size(), expected);
  test::expect_ball(filled.mesh);
}

TEST(FillHoles, HolesAreFilledInTheOrderOfTheirLowestVertices) {
  // Faces around vertices 4 and 5, with the lowest vertices 0 and 1 in another order than the triangles' own.
  const TriangleMesh open = without(octahedron(), {2, 4});
  const std::vector<Triangle> triangles = added(open, fill_holes(open));
  ASSERT_EQ(triangles.size(), 2U);
  EXPECT_EQ(as_set({triangles[0]}), as_set({Triangle{2, 0, 5}}));
  EXPECT_EQ(as_set({triangles[1]}), as_set({Triangle{1, 3, 4}}));
}

/// All ways to fill a loop (as its triangles run) with triangles over its vertices.
std::vector<std::vector<Triangle>> all_fillings(const std::vector<int>& loop) {
  if (loop.size() < 3) return {{}};
  std::vector<std::vector<Triangle>> all;
  for (std::size_t k = 1; k + 1 < loop.size(); ++k) {
    const std::vector<int> left(loop.begin(), loop.begin() + static_cast<std::ptrdiff_t>(k) + 1);
    const std::vector<int> right(loop.begin() + static_cast<std::ptrdiff_t>(k), loop.end());
    for (const auto& l : all_fillings(left))
      for (const auto& r : all_fillings(right)) {
        std::vector<Triangle> filling = l;
        filling.insert(filling.end(), r.begin(), r.end());
        filling.push_back({loop.front(), loop[k], loop.back()});
        all.push_back(filling);
      }
  }
  return all;
}

/// The sharpest bend between neighbours of which at least one is new, radians.
double sharpest_bend(const TriangleMesh& mesh, std::size_t first_new) {
  const TriangleAdjacency adjacency = triangle_adjacency(mesh);
  double most = 0;
  for (std::size_t t = first_new; t < mesh.triangles.size(); ++t)
    for (const int n : adjacency.neighbours[t])
      most = std::max(
          most, std::acos(std::clamp(triangle_normal(mesh, t).dot(triangle_normal(mesh, static_cast<std::size_t>(n))),
                                     -1.0, 1.0)));
  return most;
}

TEST(FillHoles, NoOtherFillingBendsLess) {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> wobble(-0.25, 0.25);
  for (int trial = 0; trial < 40; ++trial) {
    SCOPED_TRACE(trial);
    // A cone over a wavy hexagon, open below.
    TriangleMesh cone;
    for (int i = 0; i < 6; ++i)
      cone.vertices.emplace_back((1 + wobble(random)) * std::cos(i * std::numbers::pi / 3),
                                 (1 + wobble(random)) * std::sin(i * std::numbers::pi / 3), wobble(random));
    cone.vertices.emplace_back(0, 0, 1.5);
    for (int i = 0; i < 6; ++i) cone.triangles.push_back({i, (i + 1) % 6, 6});
    const auto fillings = all_fillings({5, 4, 3, 2, 1, 0});
    ASSERT_EQ(fillings.size(), 14U) << "the fourth Catalan number";
    double best = 4;
    for (const auto& filling : fillings) {
      TriangleMesh filled = cone;
      filled.triangles.insert(filled.triangles.end(), filling.begin(), filling.end());
      best = std::min(best, sharpest_bend(filled, 6));
    }
    EXPECT_NEAR(sharpest_bend(fill_holes(cone).mesh, 6), best, 1e-9);
  }
}

TEST(FillHoles, MovedMirroredOrRenumberedTheFillingIsTheSame) {
  TriangleMesh open = test::sphere(2);
  std::mt19937 random(4);
  std::uniform_real_distribution<double> wobble(0.9, 1.1);  // no two fillings are alike
  for (Point& p : open.vertices) p *= wobble(random);
  std::erase_if(open.triangles, [&](const Triangle& t) {
    return std::any_of(t.begin(), t.end(), [&](int v) { return open.vertices[static_cast<std::size_t>(v)].z() > 0.6; });
  });
  open = compact(open).mesh;
  const TriangleMesh filled = fill_holes(open).mesh;
  test::expect_ball(filled);
  const test::Motion motion;
  EXPECT_EQ(as_set(fill_holes(motion(open)).mesh.triangles), as_set(filled.triangles));
  EXPECT_EQ(as_set(fill_holes(test::mirrored(open)).mesh.triangles), as_set(test::mirrored(filled.triangles)));
  const std::vector<int> order = test::random_order(open.vertices.size(), 3);
  EXPECT_EQ(as_set(fill_holes(test::renumbered(open, order)).mesh.triangles),
            as_set(test::renumbered(filled, order).triangles));
}

TEST(FillHoles, ARingOfFiveHundredVerticesIsFilled) {
  constexpr int around = 500;
  TriangleMesh cone;
  for (int i = 0; i < around; ++i)
    cone.vertices.emplace_back(std::cos(2 * std::numbers::pi * i / around), std::sin(2 * std::numbers::pi * i / around),
                               0.01 * std::sin(7.0 * i));
  cone.vertices.emplace_back(0, 0, 1);
  for (int i = 0; i < around; ++i) cone.triangles.push_back({i, (i + 1) % around, around});
  const FilledMesh filled = fill_holes(cone);
  EXPECT_EQ(added(cone, filled).size(), 498U);
  EXPECT_EQ(diagnose(filled.mesh).euler_number, 2);
  EXPECT_NEAR(volume(filled.mesh), std::numbers::pi / 3, 0.01 * std::numbers::pi) << "the ring's height times its disc";
}

TEST(FillHoles, AHoleWhoseEveryDiagonalIsAnEdgeAlreadyIsRefused) {
  // The torus of seven vertices has an edge between any two of them; without one vertex a hole of six is left.
  TriangleMesh torus;
  for (int i = 0; i < 7; ++i)
    torus.vertices.emplace_back(std::cos(5.0 * i), std::sin(3.0 * i + 1), std::cos(7.0 * i + 2));
  for (int i = 0; i < 7; ++i) {
    torus.triangles.push_back({i, (i + 1) % 7, (i + 3) % 7});
    torus.triangles.push_back({i, (i + 3) % 7, (i + 2) % 7});
  }
  ASSERT_EQ(diagnose(torus).euler_number, 0);
  std::erase_if(torus.triangles, [](const Triangle& t) { return std::find(t.begin(), t.end(), 6) != t.end(); });
  torus.vertices.pop_back();
  try {
    fill_holes(torus);
    FAIL() << "was filled";
  } catch (const NoResultError& error) {
    EXPECT_EQ(error.kind(), ElementKind::vertices);
    std::vector<std::int64_t> ids = error.elements();
    std::sort(ids.begin(), ids.end());
    EXPECT_EQ(ids, (std::vector<std::int64_t>{0, 1, 2, 3, 4, 5}));
  }
}

}  // namespace
}  // namespace rhizodont
