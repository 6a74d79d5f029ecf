// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "arch/press_apart.hpp"

#include "arch/clearance.hpp"
#include "arch/resolve_collisions.hpp"
#include "arch/tapered_teeth.hpp"
#include "mesh/self_intersection.hpp"
#include "rhizodont/error.hpp"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace rhizodont {
namespace {

constexpr int sides = 48;
constexpr double row_height = 0.25;
constexpr int crown_rows = 17, rows = 48;  // the crown down to z = 0, the root to z = -8

/// A crown of radius 2 mm, 4 mm high, whose root bulges by so much 2 mm below it; its middle at z = 0 is `place`.
JoinedTooth barrel(const Point& place, double bulge) {
  JoinedTooth tooth;
  std::vector<Point>& vertices = tooth.mesh.vertices;
  vertices.push_back(place + Point(0, 0, 4));
  for (int row = 0; row < rows; ++row) {
    const double z = 4 - row_height * row, depth = std::max(0.0, -z);
    const double radius =
        depth < 4 ? 2 + bulge * std::pow(std::sin(std::numbers::pi * depth / 4), 2) : 2 - 0.4 * (depth - 4);
    for (int k = 0; k < sides; ++k) {
      const double angle = 2 * std::numbers::pi * (k + 0.5 * (row % 2)) / sides;
      vertices.push_back(place + Point(radius * std::cos(angle), radius * std::sin(angle), z));
    }
  }
  vertices.push_back(place + Point(0, 0, -8));
  const auto vertex = [](int row, int k) { return 1 + row * sides + k % sides; };
  const int last = static_cast<int>(vertices.size()) - 1;
  for (int k = 0; k < sides; ++k) tooth.mesh.triangles.push_back({0, vertex(0, k), vertex(0, k + 1)});
  for (int row = 0; row + 1 < rows; ++row) {
    if (row == crown_rows - 1) tooth.crown_triangles = static_cast<int>(tooth.mesh.triangles.size());
    const int shift = row % 2;  // odd rows stand half a side farther
    for (int k = 0; k < sides; ++k) {
      tooth.mesh.triangles.push_back({vertex(row, k), vertex(row + 1, k + shift), vertex(row, k + 1)});
      tooth.mesh.triangles.push_back({vertex(row, k + 1 - shift), vertex(row + 1, k), vertex(row + 1, k + 1)});
    }
  }
  for (int k = 0; k < sides; ++k) tooth.mesh.triangles.push_back({vertex(rows - 1, k), last, vertex(rows - 1, k + 1)});
  tooth.crown_vertices = 1 + crown_rows * sides;
  return tooth;
}

double barrels_apart(const TriangleMesh& a, const TriangleMesh& b) {
  const auto whole = [](const TriangleMesh& mesh) {
    return SolidSurface(mesh, std::vector<int>(mesh.triangles.size(), 0), 1);
  };
  return part_clearances(whole(a), whole(b))[0]->mm;
}

void expect_sound(const JoinedTooth& before, const TriangleMesh& after) {
  EXPECT_EQ(before.mesh.triangles, after.triangles);
  for (int v = 0; v < before.crown_vertices; ++v)
    EXPECT_EQ(before.mesh.vertices[static_cast<std::size_t>(v)], after.vertices[static_cast<std::size_t>(v)]);
  EXPECT_TRUE(self_intersecting_triangles(after).empty());
}

/// Two whose bulges share 0.4 mm, their crowns 0.6 mm apart.
std::vector<JoinedTooth> neighbours() { return {barrel({0, 0, 0}, 0.5), barrel({4.6, 0, 0}, 0.5)}; }

TEST(PressApart, NewSurfacesGiveWayByHalfEach) {
  const auto teeth = neighbours();
  ASSERT_NEAR(barrels_apart(teeth[0].mesh, teeth[1].mesh), -0.4, 0.03);
  const PressedTeeth pressed = press_apart(teeth);
  EXPECT_GE(barrels_apart(pressed.meshes[0], pressed.meshes[1]), 0);
  EXPECT_LE(barrels_apart(pressed.meshes[0], pressed.meshes[1]), 0.06) << "no more than needed";
  for (std::size_t i = 0; i < 2; ++i) {
    expect_sound(teeth[i], pressed.meshes[i]);
    EXPECT_NEAR(pressed.largest_mm[i], 0.2, 0.04) << "half of 0.4 mm";
    for (std::size_t v = 0; v < teeth[i].mesh.vertices.size(); ++v) {
      const Point& p = teeth[i].mesh.vertices[v];
      const double way = (pressed.meshes[i].vertices[v] - p).norm();
      EXPECT_LE(way, pressed.largest_mm[i]);
      const bool far_off = i == 0 ? p.x() < -0.5 : p.x() > 5.1;
      if (far_off || p.z() < -6.5) {
        EXPECT_EQ(way, 0) << p.transpose();
      }
    }
  }
}

TEST(PressApart, ARootGivesWayWhollyToAScan) {
  // The second stands lower: its crown is beside the first one's bulge, its own bulge beside a taper.
  const std::vector<JoinedTooth> teeth{barrel({0, 0, 0}, 0.5), barrel({4.2, 0, -4}, 0)};
  ASSERT_NEAR(barrels_apart(teeth[0].mesh, teeth[1].mesh), -0.3, 0.03);
  const PressedTeeth pressed = press_apart(teeth);
  EXPECT_GE(barrels_apart(pressed.meshes[0], pressed.meshes[1]), 0);
  EXPECT_NEAR(pressed.largest_mm[0], 0.3, 0.05);
  EXPECT_EQ(pressed.largest_mm[1], 0);
  EXPECT_EQ(pressed.meshes[1].vertices, teeth[1].mesh.vertices);
  expect_sound(teeth[0], pressed.meshes[0]);
}

TEST(PressApart, WhatIsTooDeepIsPressedSoFarAsSurfacesMayMove) {
  const std::vector<JoinedTooth> teeth{barrel({0, 0, 0}, 1.2), barrel({4.6, 0, 0}, 1.2)};
  const double before = barrels_apart(teeth[0].mesh, teeth[1].mesh);
  ASSERT_LT(before, -1.5);
  const PressedTeeth pressed = press_apart(teeth);
  EXPECT_NEAR(barrels_apart(pressed.meshes[0], pressed.meshes[1]) - before, 0.9, 0.15) << "up to 0.5 mm each";
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_LE(pressed.largest_mm[i], 0.5) << "though the smooth surface would go beyond what it is asked for";
    expect_sound(teeth[i], pressed.meshes[i]);
  }
}

TEST(PressApart, WhoTouchesNobodyStaysAsItIs) {
  auto teeth = neighbours();
  teeth.push_back(barrel({20, 0, 0}, 0.5));
  teeth.push_back(barrel({22.3, 0, 0}, 0.5));
  teeth[2].crown_vertices = teeth[3].crown_vertices = 0;  // with no scan: left out, though in each other
  teeth[2].crown_triangles = teeth[3].crown_triangles = 0;
  const PressedTeeth pressed = press_apart(teeth);
  for (const std::size_t i : {2U, 3U}) {
    EXPECT_EQ(pressed.largest_mm[i], 0);
    EXPECT_EQ(pressed.meshes[i].vertices, teeth[i].mesh.vertices);
  }
  EXPECT_GT(pressed.largest_mm[0], 0);
  const std::vector<JoinedTooth> apart{barrel({0, 0, 0}, 0.5), barrel({5.01, 0, 0}, 0.5)};
  EXPECT_EQ(press_apart(apart).largest_mm, std::vector<double>(2, 0)) << "near is not in each other";
  EXPECT_TRUE(press_apart({}).meshes.empty());
}

TEST(PressApart, TheSameInAnotherOrderAndOnOneThread) {
  // Not mirror images of each other, of which two places may be deepest.
  const std::vector<JoinedTooth> teeth{barrel({0, 0, 0}, 0.5), barrel({4.59, 0.13, 0.07}, 0.47)};
  const PressedTeeth expected = press_apart(teeth);
  auto shuffled = teeth;
  for (JoinedTooth& tooth : shuffled) {
    const auto crown_end = tooth.mesh.triangles.begin() + tooth.crown_triangles;
    std::reverse(tooth.mesh.triangles.begin(), crown_end);
    std::reverse(crown_end, tooth.mesh.triangles.end());
  }
  const PressedTeeth others = press_apart(shuffled);
  tbb::task_arena alone(1);
  const PressedTeeth one = alone.execute([&] { return press_apart(teeth); });
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_TRUE(expected.meshes[i].vertices == others.meshes[i].vertices);
    EXPECT_TRUE(expected.meshes[i].vertices == one.meshes[i].vertices);
  }
}

TEST(PressApart, RefusesWhatIsOutOfRange) {
  for (const auto& spoil : {+[](PressOptions& o) { o.gap = 0; }, +[](PressOptions& o) { o.most = 2.1; },
                            +[](PressOptions& o) { o.reach = std::nan(""); }, +[](PressOptions& o) { o.rounds = 0; }}) {
    PressOptions options;
    spoil(options);
    EXPECT_THROW(press_apart(neighbours(), options), UsageError);
  }
}

/// A trial of a tooth that is not steered in the test that uses it: any steering leaves it as it is.
SteerableRoot unsteerable(const JoinedTooth& tooth, int fdi) {
  SteerableRoot root;
  root.fdi = fdi;
  root.triangles = tooth.mesh.triangles;
  root.source.assign(tooth.mesh.vertices.size(), VertexSource::predicted);
  std::fill_n(root.source.begin(), tooth.crown_vertices, VertexSource::scan);
  root.vertices = [mesh = tooth.mesh](const RootSteering&) { return mesh.vertices; };
  root.length = [](const RootSteering&) { return 8.0; };
  root.length_mm = root.shortest_mm = 8;
  return root;
}

TEST(PressApart, IsWhatResolvingDoesWhereNoRootCanTurnAway) {
  const auto joined = neighbours();
  std::vector<SteerableRoot> roots;
  std::vector<SourcedTooth> teeth;
  for (std::size_t i = 0; i < 2; ++i) {
    roots.push_back(unsteerable(joined[i], 14 + static_cast<int>(i)));
    teeth.push_back({joined[i].mesh, roots[i].source, joined[i].crown_vertices, joined[i].crown_triangles});
  }
  const FinishTooth never = [](std::size_t, const RootSteering&) -> SourcedTooth {
    ADD_FAILURE();
    return {};
  };
  const ResolvedCollisions resolved = resolve_collisions(roots, teeth, never);
  EXPECT_GT(resolved.pressed_mm[0], 0.1);
  EXPECT_EQ(resolved.cost_mm, std::vector<double>(2, 0));
  EXPECT_GE(barrels_apart(resolved.teeth[0].mesh, resolved.teeth[1].mesh), 0);
  ASSERT_EQ(resolved.unresolved.size(), 1U) << "half a millimetre was asked for";
  EXPECT_GE(resolved.unresolved[0].clearance_mm, 0);
  for (SourcedTooth& tooth : teeth) tooth.scanned_vertices = tooth.scanned_triangles = 0;
  const ResolvedCollisions unpressed = resolve_collisions(roots, teeth, never);
  ASSERT_EQ(unpressed.unresolved.size(), 1U);
  EXPECT_LT(unpressed.unresolved[0].clearance_mm, -0.3);
}

TEST(PressApart, WhatClosesCrownsGivesWayWhereRootsStandApart) {
  const auto joined = neighbours();
  std::vector<SteerableRoot> roots;
  std::vector<SourcedTooth> teeth;
  for (std::size_t i = 0; i < 2; ++i) {
    roots.push_back(unsteerable(joined[i], 14 + static_cast<int>(i)));
    // The bulges count as the crowns', as what a scan hides at a contact does.
    teeth.push_back({joined[i].mesh, roots[i].source, joined[i].crown_vertices, joined[i].crown_triangles, -4.1,
                     Eigen::Vector3d::UnitZ()});
  }
  ResolveOptions options;
  options.search.clearance = 0;
  const FinishTooth never = [](std::size_t, const RootSteering&) -> SourcedTooth {
    ADD_FAILURE();
    return {};
  };
  const ResolvedCollisions resolved = resolve_collisions(roots, teeth, never, options);
  EXPECT_TRUE(resolved.unresolved.empty());
  EXPECT_GE(barrels_apart(resolved.teeth[0].mesh, resolved.teeth[1].mesh), 0);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR(resolved.pressed_mm[i], 0.2, 0.04) << "half of 0.4 mm";
}

TEST(PressApart, WhatStaysNearIsToldByThePartsThatPressedTeethHave) {
  const auto joined = neighbours();
  std::vector<SteerableRoot> roots;
  std::vector<SourcedTooth> teeth;
  for (std::size_t i = 0; i < 2; ++i) {
    const double towards_other = i == 0 ? 1 : -1;
    roots.push_back(unsteerable(joined[i], 14 + static_cast<int>(i)));
    // Where the two lie in each other counts as the crowns', and no more once it has given way.
    teeth.push_back({joined[i].mesh, roots[i].source, joined[i].crown_vertices, joined[i].crown_triangles,
                     towards_other * 2.3 - 0.01, towards_other * Eigen::Vector3d::UnitX()});
  }
  const FinishTooth never = [](std::size_t, const RootSteering&) -> SourcedTooth { throw NoResultError("never"); };
  const ResolvedCollisions resolved = resolve_collisions(roots, teeth, never);
  const auto of_roots = [&](bool anew) {
    std::vector<SolidSurface> surfaces;
    for (std::size_t i = 0; i < 2; ++i) {
      const TriangleMesh& pressed = resolved.teeth[i].mesh;
      std::vector<VertexSource> parts = teeth[i].source;
      for (std::size_t v = 0; v < parts.size(); ++v)
        if (teeth[i].up.dot((anew ? pressed : teeth[i].mesh).vertices[v]) > teeth[i].root_begins)
          parts[v] = VertexSource::scan;
      surfaces.push_back(tooth_surface(pressed, parts));
    }
    return clearance_of(surfaces[0], surfaces[1]).of_roots()->mm;
  };
  ASSERT_EQ(resolved.unresolved.size(), 1U);
  EXPECT_GT(std::abs(of_roots(true) - of_roots(false)), 1e-4) << "else this test could not fail";
  EXPECT_NEAR(resolved.unresolved[0].clearance_mm, of_roots(true), 1e-9);
}

TEST(PressApart, RootsTurnOutOfTheWayFartherDown) {
  // Roots that run together far below: turned apart, and hardly pressed.
  std::vector<test::TaperedTooth> shapes(2);
  shapes[0].neck = {-3.2, 0, 0};
  shapes[1].neck = {3.2, 0, 0};
  shapes[0].lean_x = 0.25;
  shapes[1].lean_x = -0.25;
  std::vector<SteerableRoot> roots;
  std::vector<SourcedTooth> teeth;
  for (std::size_t i = 0; i < 2; ++i) {
    roots.push_back(shapes[i].trial(35 + static_cast<int>(i)));
    teeth.push_back(shapes[i].solid());
  }
  const auto finish = [&](std::size_t i, const RootSteering& steering) {
    return shapes[i].steered(35 + static_cast<int>(i), steering);
  };
  const ResolvedCollisions resolved = resolve_collisions(roots, teeth, finish);
  EXPECT_TRUE(resolved.unresolved.empty());
  EXPECT_EQ(resolved.pressed_mm, std::vector<double>(2, 0));
}

}  // namespace
}  // namespace rhizodont
