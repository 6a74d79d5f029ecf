// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// A hexagon of 24 equilateral triangles in a plane, spoiled in ways that one operation each sets right.

#include "fusion/mend_angles.hpp"

#include "fusion/remesh_root.hpp"
#include "fusion/tiny_patches.hpp"
#include "mesh/adjacency.hpp"
#include "rhizodont/error.hpp"

#include <cmath>
#include <numbers>

namespace rhizodont {
namespace {

using test::as_set;

constexpr double degree = std::numbers::pi / 180;
constexpr int border = 12, centre = 12;  // vertices [0, 12) are the border, 12 the centre, 13 to 18 around it

/// The hexagon of side 2, triangles of side 1, counterclockwise from above.
TriangleMesh lattice() {
  std::vector<Point> inner{{0, 0, 0}}, outer;
  for (int i = 0; i < 6; ++i) {
    const Point a(std::cos(60 * i * degree), std::sin(60 * i * degree), 0);
    const Point b(std::cos(60 * (i + 1) * degree), std::sin(60 * (i + 1) * degree), 0);
    inner.push_back(a);
    outer.emplace_back(2 * a);
    outer.emplace_back(a + b);
  }
  TriangleMesh mesh{outer, {}};
  mesh.vertices.insert(mesh.vertices.end(), inner.begin(), inner.end());
  for (int i = 0; i < 6; ++i) {
    const int j = (i + 1) % 6, a = 13 + i, b = 13 + j;
    mesh.triangles.push_back({centre, a, b});
    mesh.triangles.push_back({a, 2 * i, 2 * i + 1});
    mesh.triangles.push_back({a, 2 * i + 1, b});
    mesh.triangles.push_back({b, 2 * i + 1, 2 * j});
  }
  return mesh;
}

/// All of whose triangles are new; the border's vertices are the crown's.
JoinedTooth new_triangles(const TriangleMesh& mesh) { return {mesh, border, 0, 0, 0, 0}; }

/// The plane that the patch lies on, and a wanted length of 1 everywhere.
struct Plane {
  TriangleMesh surface;
  SurfaceWalk walk;
  EdgeLengths lengths;

  explicit Plane(const std::function<TriangleMesh(const TriangleMesh&)>& moved =
                     [](const TriangleMesh& m) { return m; })
      : surface(moved(wide_grid())), walk(surface), lengths(crown(), find_crown_border(crown()), 1, 1, 1) {}

 private:
  static TriangleMesh wide_grid() {
    TriangleMesh mesh = test::grid(8);
    for (Point& p : mesh.vertices) p -= Point(4.1, 3.9, 0);
    return mesh;
  }
  /// A triangle of side 1.
  static TriangleMesh crown() { return {{{0, 0, 0}, {1, 0, 0}, {0.5, std::sqrt(0.75), 0}}, {{0, 1, 2}}}; }
};

int half_edge(const PatchMesh& mesh, int a, int b) {
  for (int h = 0; h < mesh.half_edges(); ++h)
    if (mesh.is_alive(h) && mesh.from(h) == a && mesh.to(h) == b) return h;
  return -1;
}

double smallest_angle_of(const FittedPatch& patch) {
  double smallest = 4;
  for (int h = 0; h < patch.mesh().half_edges(); h += 3)
    if (patch.mesh().is_alive(h)) smallest = std::min(smallest, patch.smallest_angle_at(h));
  return smallest;
}

MendingBudget plenty() { return {1000, 100000}; }

/// The border where it was, a disc, all its triangles facing up.
void expect_disc(const TriangleMesh& before, const FittedPatch& patch) {
  for (int v = 0; v < border; ++v) EXPECT_EQ(patch.point(v), before.vertices[static_cast<std::size_t>(v)]);
  const TriangleMesh now = compact({patch.mesh().points, patch.mesh().triangles()}).mesh;
  const Diagnosis found = diagnose(now);
  EXPECT_TRUE(found.is_oriented_manifold());
  EXPECT_EQ(found.euler_number, 1);
  EXPECT_EQ(border_loops({patch.mesh().points, patch.mesh().triangles()}), border_loops(before));
  double area = 0;
  for (std::size_t t = 0; t < now.triangles.size(); ++t) {
    EXPECT_GT(triangle_area_vector(now, t).z(), 0);
    area += triangle_area(now, t);
  }
  EXPECT_NEAR(area, 6 * std::sqrt(3.0), 1e-9) << "no overlap, no gap";
}

TEST(SmallestAngle, OfTrianglesThatAreKnown) {
  const Point o(0, 0, 0);
  EXPECT_NEAR(smallest_angle(o, {1, 0, 0}, {0.5, std::sqrt(0.75), 0}), 60 * degree, 1e-12);
  EXPECT_NEAR(smallest_angle(o, {3, 0, 0}, {0, 4, 0}), std::atan2(3, 4), 1e-12);
  EXPECT_NEAR(smallest_angle({3, 0, 0}, {0, 4, 0}, o), std::atan2(3, 4), 1e-12);
  EXPECT_NEAR(smallest_angle({0, 4, 0}, o, {3, 0, 0}), std::atan2(3, 4), 1e-12);
  EXPECT_EQ(smallest_angle(o, o, {1, 0, 0}), 0);
  EXPECT_EQ(smallest_angle(o, {1, 0, 0}, {2, 0, 0}), 0);
}

TEST(MendAngles, LeavesEquilateralTrianglesAlone) {
  const Plane plane;
  FittedPatch patch(new_triangles(lattice()), plane.walk, plane.lengths);
  MendingBudget budget = plenty();
  EXPECT_EQ(mend_angles(patch, 59.9 * degree, 10, budget), 0);
  EXPECT_EQ(budget.places, 100000);
  EXPECT_EQ(patch.mesh().points, lattice().vertices);
  EXPECT_EQ(patch.mesh().triangles(), lattice().triangles);
}

TEST(MendAngles, TurnsAnEdgeBack) {
  const Plane plane;
  FittedPatch patch(new_triangles(lattice()), plane.walk, plane.lengths);
  patch.flip(half_edge(patch.mesh(), centre, 13));
  ASSERT_NEAR(smallest_angle_of(patch), 30 * degree, 1e-12);
  MendingBudget budget = plenty();
  EXPECT_EQ(mend_angles(patch, 29 * degree, 10, budget), 0) << "nothing is below the bound";
  EXPECT_EQ(mend_angles(patch, 31 * degree, 10, budget), 1);
  EXPECT_EQ(as_set(patch.mesh().triangles()), as_set(lattice().triangles));
  EXPECT_EQ(patch.mesh().points, lattice().vertices);
  EXPECT_EQ(budget.places, 100000) << "a turn tries no places";
}

TEST(MendAngles, CollapsesAShortEdge) {
  const Plane plane;
  FittedPatch patch(new_triangles(lattice()), plane.walk, plane.lengths);
  const int extra = patch.split(half_edge(patch.mesh(), centre, 13));
  patch.move(extra, patch.fit(extra, Point(0.02, 0, 0)));
  ASSERT_LT(smallest_angle_of(patch), 2 * degree);
  MendingBudget budget = plenty();
  EXPECT_EQ(mend_angles(patch, 28 * degree, 10, budget), 1);
  EXPECT_EQ(patch.mesh().triangles().size(), lattice().triangles.size());
  EXPECT_GT(smallest_angle_of(patch), 55 * degree);
  expect_disc(lattice(), patch);
}

TEST(MendAngles, MovesAVertexAwayFromItsNeighbour) {
  TriangleMesh spoiled = lattice();
  spoiled.vertices[centre] = Point(0.35, 0.05, 0);
  const Plane plane;
  FittedPatch patch(new_triangles(spoiled), plane.walk, plane.lengths);
  const double before = smallest_angle_of(patch);
  ASSERT_LT(before, 48 * degree);
  MendingBudget budget{0, 100000};
  EXPECT_GT(mend_angles(patch, 48 * degree, 10, budget), 0);
  EXPECT_GE(smallest_angle_of(patch), 48 * degree);
  EXPECT_LT(budget.places, 100000);
  EXPECT_EQ(patch.mesh().triangles(), spoiled.triangles);
  expect_disc(spoiled, patch);
}

TEST(MendAngles, SplitsAnEdgeBetweenTwoVerticesOfTheBorder) {
  // A flat square over one diagonal between fixed corners: nothing can be turned, collapsed or moved.
  const TriangleMesh kite{{{-1, 0, 0}, {0, -0.2, 0}, {1, 0, 0}, {0, 0.2, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  const Plane plane;
  JoinedTooth tooth = new_triangles(kite);
  tooth.crown_vertices = 4;
  FittedPatch patch(tooth, plane.walk, plane.lengths);
  MendingBudget none{0, 1000}, one{1, 1000};
  EXPECT_EQ(mend_angles(patch, 28 * degree, 1, none), 0);
  EXPECT_EQ(patch.mesh().triangles(), kite.triangles);
  EXPECT_EQ(mend_angles(patch, 28 * degree, 1, one), 1);
  EXPECT_EQ(one.splits, 0);
  ASSERT_EQ(patch.mesh().points.size(), 5U);
  EXPECT_EQ(patch.point(4), Point(0, 0, 0));
  EXPECT_EQ(patch.mesh().triangles().size(), 4U);
}

TEST(MendAngles, WithoutABudgetOrRoundsNothingIsDone) {
  TriangleMesh spoiled = lattice();
  spoiled.vertices[centre] = Point(0.7, 0.1, 0);
  const Plane plane;
  FittedPatch patch(new_triangles(spoiled), plane.walk, plane.lengths);
  MendingBudget nothing{0, 0}, budget = plenty();
  EXPECT_EQ(mend_angles(patch, 40 * degree, 10, nothing), 0);
  EXPECT_EQ(mend_angles(patch, 40 * degree, 0, budget), 0);
  EXPECT_EQ(patch.mesh().points, spoiled.vertices);
  EXPECT_EQ(patch.mesh().triangles(), spoiled.triangles);
}

TEST(MendAngles, WhatIsFrozenStays) {
  TriangleMesh spoiled = lattice();
  spoiled.vertices[centre] = Point(0.7, 0.1, 0);
  const Plane plane;
  FittedPatch patch(new_triangles(spoiled), plane.walk, plane.lengths);
  patch.freeze({Point::Zero()}, 1.1);  // all but the border
  MendingBudget budget = plenty();
  EXPECT_EQ(mend_angles(patch, 40 * degree, 10, budget), 0);
  EXPECT_EQ(patch.mesh().points, spoiled.vertices);
  EXPECT_EQ(patch.mesh().triangles(), spoiled.triangles);
}

/// Inner vertices moved at random, far but so that no triangle turns over.
TriangleMesh shaken(unsigned seed, double most = 0.8) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> wobble(-most, most);
  TriangleMesh mesh = lattice();
  for (std::size_t v = border; v < mesh.vertices.size(); ++v) {
    const Point before = mesh.vertices[v];
    const Eigen::Vector3d move(wobble(random), wobble(random), 0);
    const auto turns_over = [&] {
      for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        if (triangle_area_vector(mesh, t).z() < 0.01) return true;
      return false;
    };
    for (double share = 1; share > 0.1; share *= 0.7) {
      mesh.vertices[v] = before + share * move;
      if (!turns_over()) break;
      mesh.vertices[v] = before;
    }
  }
  return mesh;
}

TEST(MendAngles, TheSmallestAngleNeverFallsAndThePatchStaysADisc) {
  const Plane plane;
  int reached = 0;
  for (unsigned seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    const TriangleMesh before = shaken(seed);
    FittedPatch patch(new_triangles(before), plane.walk, plane.lengths);
    double smallest = smallest_angle_of(patch);
    for (int round = 0; round < 8; ++round) {
      MendingBudget budget{4, 400};
      mend_angles(patch, 28 * degree, 1, budget);
      EXPECT_GE(smallest_angle_of(patch), smallest - 1e-12);
      smallest = smallest_angle_of(patch);
    }
    expect_disc(before, patch);
    reached += static_cast<int>(smallest >= 28 * degree);
  }
  EXPECT_GE(reached, 55) << "of 60 reach the bound";
}

TEST(MendAngles, MovedInSpaceThePatchIsMendedAlike) {
  const test::Motion motion;
  const Plane plane, moved_plane(motion);
  for (unsigned seed = 100; seed < 110; ++seed) {
    FittedPatch patch(new_triangles(shaken(seed)), plane.walk, plane.lengths);
    FittedPatch moved(new_triangles(motion(shaken(seed))), moved_plane.walk, moved_plane.lengths);
    MendingBudget budget = plenty(), other = plenty();
    EXPECT_EQ(mend_angles(patch, 28 * degree, 10, budget), mend_angles(moved, 28 * degree, 10, other));
    EXPECT_EQ(budget.places, other.places);
    ASSERT_EQ(patch.mesh().triangles(), moved.mesh().triangles());
    for (std::size_t v = 0; v < patch.mesh().points.size(); ++v)
      EXPECT_LT((motion(patch.mesh().points[v]) - moved.mesh().points[v]).norm(), 1e-6);
  }
}

RemeshRootOptions only_iterations(int count) {
  RemeshRootOptions options;
  options.iterations = count;
  options.mending_passes = 0;
  return options;
}

TEST(RemeshRoot, TurnsEdgesUntilTheyAreDelaunay) {
  const Plane plane;
  TriangleMesh spoiled = lattice();
  FittedPatch patch(new_triangles(spoiled), plane.walk, plane.lengths);
  patch.flip(half_edge(patch.mesh(), centre, 13));
  patch.flip(half_edge(patch.mesh(), centre, 16));
  spoiled.triangles = patch.mesh().triangles();
  JoinedTooth tooth = new_triangles(spoiled);
  const RootRemeshing done = remesh_root(tooth, plane.walk, plane.lengths, {}, 0, only_iterations(0));
  EXPECT_EQ(done.flips, 2);
  EXPECT_EQ(done.splits + done.collapses + done.mended, 0);
  EXPECT_EQ(tooth.mesh.triangles.size(), 24U);
  EXPECT_NEAR(test::smallest_angle_of(tooth.mesh), 60 * degree, 1e-12);
}

TEST(RemeshRoot, SplitsLongEdgesAndCollapsesShortOnes) {
  TriangleMesh large = lattice(), small = lattice();
  for (Point& p : large.vertices) p *= 1.7;
  for (Point& p : small.vertices) p *= 0.45;
  const Plane plane;  // wants edges of length 1
  JoinedTooth coarse = new_triangles(large), fine = new_triangles(small);
  const RootRemeshing finer = remesh_root(coarse, plane.walk, plane.lengths, {}, 0, only_iterations(1));
  EXPECT_GE(finer.splits, 12) << "at least one edge of each two triangles";
  EXPECT_EQ(finer.collapses, 0);
  EXPECT_EQ(coarse.mesh.triangles.size(), 24U + 2 * static_cast<std::size_t>(finer.splits));
  const RootRemeshing coarser = remesh_root(fine, plane.walk, plane.lengths, {}, 0, only_iterations(1));
  EXPECT_EQ(coarser.splits, 0);
  EXPECT_GE(coarser.collapses, 3);
  EXPECT_EQ(fine.mesh.triangles.size(), 24U - 2 * static_cast<std::size_t>(coarser.collapses));
}

TEST(RemeshRoot, AVertexMovesToTheMeanOfTheCircumcentresAround) {
  // In a rectangle of 4 by 2, half a unit above the middle. The triangles over the long sides are obtuse there: the
  // middles of these sides count, with areas 1 and 3; the others have circumcentres at (1.1875, 0) and (-1.1875, 0).
  const TriangleMesh rectangle{{{-2, -1, 0}, {2, -1, 0}, {2, 1, 0}, {-2, 1, 0}, {0, 0.5, 0}},
                               {{0, 1, 4}, {2, 4, 1}, {4, 2, 3}, {3, 0, 4}}};
  const Plane plane;
  JoinedTooth tooth{rectangle, 4, 0, 0, 0, 0};
  RemeshRootOptions options = only_iterations(1);
  options.longest = 10;
  options.shortest = 1e-3;
  remesh_root(tooth, plane.walk, plane.lengths, {}, 0, options);
  ASSERT_EQ(tooth.mesh.vertices.size(), 5U);
  EXPECT_LT((tooth.mesh.vertices[4] - Point(0, (1.0 - 3.0) / 8, 0)).norm(), 1e-12) << tooth.mesh.vertices[4];
}

TEST(RemeshRoot, RelaxingBringsAShakenLatticeBack) {
  const Plane plane;
  for (unsigned seed = 0; seed < 10; ++seed) {
    SCOPED_TRACE(seed);
    JoinedTooth tooth = new_triangles(shaken(seed, 0.15));
    RemeshRootOptions options;
    options.longest = 10;  // neither split nor collapsed: the lattice's own triangles
    options.shortest = 1e-3;
    options.iterations = 200;
    remesh_root(tooth, plane.walk, plane.lengths, {}, 0, options);
    ASSERT_EQ(tooth.mesh.triangles.size(), 24U);
    EXPECT_GT(test::smallest_angle_of(tooth.mesh), 59 * degree);
    for (const Point& p : lattice().vertices) {
      double nearest = 1;
      for (const Point& q : tooth.mesh.vertices) nearest = std::min(nearest, (p - q).norm());
      EXPECT_LT(nearest, 0.01);
    }
  }
}

TEST(RemeshRoot, WhatIsFrozenStaysAsItWas) {
  const Plane plane;
  const TriangleMesh before = shaken(3);
  JoinedTooth tooth = new_triangles(before);
  const RootRemeshing done = remesh_root(tooth, plane.walk, plane.lengths, {Point::Zero()}, 5);
  EXPECT_EQ(done.splits + done.collapses + done.flips + done.mended, 0);
  EXPECT_EQ(tooth.mesh.triangles, before.triangles);
  for (std::size_t v = 0; v < before.vertices.size(); ++v)
    EXPECT_LT((tooth.mesh.vertices[v] - before.vertices[v]).norm(), 1e-12);
}

TEST(RemeshRoot, TheCrownStaysAndTheToothStaysABall) {
  // The upper half of a ball on a root of far larger triangles.
  const TriangleMesh crown = test::dome(3, 3);
  JoinedTooth tooth{crown, static_cast<int>(crown.vertices.size()), static_cast<int>(crown.triangles.size()), 0, 0, 0};
  const std::vector<int> loop = border_loops(crown).front();
  const auto tip = static_cast<std::int32_t>(crown.vertices.size());
  tooth.mesh.vertices.emplace_back(0, 0, -3);
  for (std::size_t i = 0; i < loop.size(); ++i)
    tooth.mesh.triangles.push_back({loop[(i + 1) % loop.size()], loop[i], tip});
  test::expect_ball(tooth.mesh);
  const double before = test::smallest_angle_of(tooth.mesh, crown.triangles.size());
  const TriangleMesh surface = test::sphere(4, 3);
  const SurfaceWalk walk(surface);
  const EdgeLengths lengths(crown, find_crown_border(crown), 0.5, 0.9, 0.15);
  const RootRemeshing done = remesh_root(tooth, walk, lengths, {}, 0);
  EXPECT_GT(done.splits, 100);
  test::expect_crown_kept(crown, tooth);
  test::expect_ball(tooth.mesh);
  EXPECT_GT(test::smallest_angle_of(tooth.mesh, crown.triangles.size()), before);
}

TEST(RemeshRoot, OptionsOutOfRange) {
  const Plane plane;
  JoinedTooth tooth = new_triangles(lattice());
  RemeshRootOptions options;
  options.longest = 1;
  EXPECT_THROW(remesh_root(tooth, plane.walk, plane.lengths, {}, 0, options), UsageError);
  EXPECT_EQ(tooth.mesh.triangles, lattice().triangles);
}

}  // namespace
}  // namespace rhizodont
