// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "arch/resolve_collisions.hpp"

#include "arch/tapered_teeth.hpp"
#include "rhizodont/error.hpp"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace rhizodont {
namespace {

using test::TaperedTooth;

struct Row {
  std::vector<TaperedTooth> shapes;
  std::vector<int> fdi;

  std::vector<SteerableRoot> roots() const {
    std::vector<SteerableRoot> all;
    for (std::size_t i = 0; i < shapes.size(); ++i) all.push_back(shapes[i].trial(fdi[i]));
    return all;
  }
  std::vector<SourcedTooth> teeth() const {
    std::vector<SourcedTooth> all;
    for (const TaperedTooth& shape : shapes) all.push_back(shape.solid());
    return all;
  }
  FinishTooth finish() const {
    return [this](std::size_t i, const RootSteering& steering) { return shapes[i].steered(fdi[i], steering); };
  }
};

Clearance measured(const std::vector<SourcedTooth>& teeth, std::size_t i, std::size_t j) {
  return clearance_of(tooth_surface(teeth[i].mesh, teeth[i].source), tooth_surface(teeth[j].mesh, teeth[j].source));
}

bool is_unchanged(const RootSteering& steering) { return !steering.any(); }

void expect_crowns_unmoved(const std::vector<SourcedTooth>& before, const std::vector<SourcedTooth>& after) {
  ASSERT_EQ(before.size(), after.size());
  for (std::size_t i = 0; i < before.size(); ++i)
    for (std::size_t v = 0; v < before[i].source.size(); ++v) {
      if (before[i].source[v] != VertexSource::scan) continue;
      EXPECT_EQ(before[i].mesh.vertices[v], after[i].mesh.vertices[v]);
    }
}

/// Crowns 1.4 mm apart, roots that run together.
Row converging_pair(double lean = 0.25) {
  Row row;
  row.shapes.resize(2);
  row.fdi = {35, 36};
  row.shapes[0].neck = {-3.2, 0, 0};
  row.shapes[1].neck = {3.2, 0, 0};
  row.shapes[0].lean_x = lean;
  row.shapes[1].lean_x = -lean;
  return row;
}

TEST(ResolveCollisions, TwoConvergingRootsShareTheChange) {
  const Row row = converging_pair();
  const auto teeth = row.teeth();
  EXPECT_LT(measured(teeth, 0, 1).root_root->mm, -0.5);
  const ResolvedCollisions found = resolve_collisions(row.roots(), teeth, row.finish());
  EXPECT_TRUE(found.unresolved.empty());
  const double clearance = measured(found.teeth, 0, 1).of_roots()->mm;
  EXPECT_GE(clearance, 0.499);
  EXPECT_LE(clearance, 0.53) << "no more than asked for";
  expect_crowns_unmoved(teeth, found.teeth);
  // Mirror images of each other: the same change in either.
  EXPECT_NEAR(found.cost_mm[0], found.cost_mm[1], 0.05);
  EXPECT_NEAR(found.steering[0].tip_degrees, -found.steering[1].tip_degrees, 0.3);
  EXPECT_LT(std::abs(found.steering[0].torque_degrees), 1.5);
  // The apices, of 0.7 mm radius each, lie 0.3 mm beyond the middle; 1.25 mm each would do if all were moved aside.
  EXPECT_LT(found.cost_mm[0], 1.25);
  EXPECT_GT(found.cost_mm[0], 0.9);
  // A little less would not do.
  std::vector<SourcedTooth> less;
  for (std::size_t i = 0; i < 2; ++i) {
    RootSteering steering = found.steering[i];
    steering.tip_degrees *= 0.95;
    steering.torque_degrees *= 0.95;
    steering.bend_degrees *= 0.95;
    less.push_back(row.shapes[i].steered(row.fdi[i], steering));
  }
  EXPECT_LT(measured(less, 0, 1).of_roots()->mm, 0.49);
}

TEST(ResolveCollisions, TheLeastChangeIsNoLargerThanTurnsAlone) {
  // By turning both alike and nothing else, in fine steps.
  const Row row = converging_pair();
  double least = std::numeric_limits<double>::infinity();
  for (double degrees = 0; degrees < 10 && std::isinf(least); degrees += 0.1) {
    RootSteering a, b;
    a.tip_degrees = degrees;
    b.tip_degrees = -degrees;
    for (const double sign : {1.0, -1.0}) {
      a.tip_degrees = sign * degrees;
      b.tip_degrees = -sign * degrees;
      if (measured({row.shapes[0].steered(35, a), row.shapes[1].steered(36, b)}, 0, 1).of_roots()->mm >= 0.5)
        least = degrees * std::numbers::pi / 180 * 12.5 * std::numbers::sqrt2;
    }
  }
  const ResolvedCollisions found = resolve_collisions(row.roots(), row.teeth(), row.finish());
  EXPECT_LE(std::hypot(found.cost_mm[0], found.cost_mm[1]), least + 0.05);
}

TEST(ResolveCollisions, ThreeInARow) {
  Row row;
  row.shapes.resize(3);
  row.fdi = {31, 32, 33};
  for (std::size_t i = 0; i < 3; ++i) row.shapes[i].neck = {6.2 * static_cast<double>(i), 0, 0};
  row.shapes[0].lean_x = 0.35;
  row.shapes[1].lean_x = 0.05;
  row.shapes[2].lean_x = -0.33;
  const auto teeth = row.teeth();
  EXPECT_LT(measured(teeth, 1, 2).root_root->mm, 0);
  const ResolvedCollisions found = resolve_collisions(row.roots(), teeth, row.finish());
  EXPECT_TRUE(found.unresolved.empty());
  for (std::size_t i = 0; i < 2; ++i) EXPECT_GE(measured(found.teeth, i, i + 1).of_roots()->mm, 0.499);
  expect_crowns_unmoved(teeth, found.teeth);
}

TEST(ResolveCollisions, WhatStandsApartStaysAsItIs) {
  Row row = converging_pair(0.05);
  row.shapes.push_back(row.shapes[0]);  // a third one, far off, that its user has steered
  row.fdi.push_back(46);
  row.shapes[2].neck = {40, 0, 0};
  auto roots = row.roots();
  roots[2].start.tip_degrees = 1.0 / 3;
  const FinishTooth never = [](std::size_t, const RootSteering&) -> SourcedTooth {
    ADD_FAILURE();
    return {};
  };
  const ResolvedCollisions found = resolve_collisions(roots, row.teeth(), never);
  EXPECT_TRUE(found.unresolved.empty());
  for (const std::size_t i : {0U, 1U}) EXPECT_TRUE(is_unchanged(found.steering[i]));
  EXPECT_EQ(found.steering[2].tip_degrees, 1.0 / 3);
  EXPECT_EQ(found.cost_mm, std::vector<double>(3, 0));
  // Also beside teeth that have to change.
  Row crowded = converging_pair();
  crowded.shapes.push_back(row.shapes[2]);
  crowded.fdi.push_back(46);
  auto some = crowded.roots();
  some[2].start.tip_degrees = 1.0 / 3;
  const ResolvedCollisions others = resolve_collisions(some, crowded.teeth(), crowded.finish());
  EXPECT_EQ(others.steering[2].tip_degrees, 1.0 / 3);
  EXPECT_FALSE(others.steering[2].length_mm);
  EXPECT_FALSE(is_unchanged(others.steering[0]));
}

TEST(ResolveCollisions, NecksNearerThanTheClearanceAreSaid) {
  Row row = converging_pair(0.0);
  row.shapes[0].neck.x() = -2.6;
  row.shapes[1].neck.x() = 2.6;  // 0.2 mm at the necks
  row.shapes[0].apex_radius = row.shapes[1].apex_radius = 2.4;
  const auto teeth = row.teeth();
  const ResolvedCollisions found = resolve_collisions(row.roots(), teeth, row.finish());
  ASSERT_EQ(found.unresolved.size(), 1U);
  const UnresolvedCollision& left = found.unresolved[0];
  EXPECT_EQ(left.first, 0U);
  EXPECT_EQ(left.second, 1U);
  EXPECT_NE(left.sentence.find("35 and 36"), std::string::npos) << left.sentence;
  expect_crowns_unmoved(teeth, found.teeth);
  for (const double cost : found.cost_mm) EXPECT_LT(cost, 3) << "nothing out of proportion";
  // What can be done is done: lower down they stand apart.
  const auto apart_below = [&](const std::vector<SourcedTooth>& all) {
    const std::size_t apex = all[0].mesh.vertices.size() - 1;
    return (all[0].mesh.vertices[apex] - all[1].mesh.vertices[apex]).norm();
  };
  EXPECT_GT(apart_below(found.teeth), apart_below(teeth) + 0.2);
}

TEST(ResolveCollisions, OnlyNecksNear) {
  Row row = converging_pair(0.0);
  row.shapes[0].neck.x() = -2.6;
  row.shapes[1].neck.x() = 2.6;
  row.shapes[0].lean_x = -0.3;
  row.shapes[1].lean_x = 0.3;
  const ResolvedCollisions found = resolve_collisions(row.roots(), row.teeth(), row.finish());
  ASSERT_EQ(found.unresolved.size(), 1U);
  EXPECT_EQ(found.unresolved[0].cause, CollisionCause::necks);
  EXPECT_NEAR(found.unresolved[0].clearance_mm, 0.2, 0.05);
  for (const double cost : found.cost_mm) EXPECT_LT(cost, 0.2);
}

TEST(ResolveCollisions, AToothThatMayNotChangeMakesOthersGiveWay) {
  const Row row = converging_pair();
  auto roots = row.roots();
  roots[0].may_change = false;
  const ResolvedCollisions found = resolve_collisions(roots, row.teeth(), row.finish());
  EXPECT_TRUE(found.unresolved.empty());
  EXPECT_TRUE(is_unchanged(found.steering[0]));
  EXPECT_GE(measured(found.teeth, 0, 1).of_roots()->mm, 0.499);
  roots[1].may_change = false;
  const ResolvedCollisions none = resolve_collisions(roots, row.teeth(), row.finish());
  ASSERT_EQ(none.unresolved.size(), 1U);
  EXPECT_EQ(none.unresolved[0].cause, CollisionCause::at_limit);
  EXPECT_NE(none.unresolved[0].sentence.find("into each other"), std::string::npos);
}

TEST(ResolveCollisions, ALengthThatIsKnownStays) {
  const Row row = converging_pair();
  auto roots = row.roots();
  for (SteerableRoot& root : roots) root.start.length_mm = 14;
  const ResolvedCollisions found = resolve_collisions(roots, row.teeth(), row.finish());
  for (const RootSteering& steering : found.steering) EXPECT_EQ(*steering.length_mm, 14);
  EXPECT_TRUE(found.unresolved.empty());
}

TEST(ResolveCollisions, FinishedTeethThatAreThickerAreAskedForMore) {
  const Row row = converging_pair();
  Row thick = row;
  for (TaperedTooth& shape : thick.shapes) {
    shape.apex_radius += 0.1;
    shape.sides = 26;
  }
  int made = 0;
  const FinishTooth finish = [&](std::size_t i, const RootSteering& steering) {
    ++made;
    return thick.shapes[i].steered(thick.fdi[i], steering);
  };
  const ResolvedCollisions found = resolve_collisions(row.roots(), thick.teeth(), finish);
  EXPECT_TRUE(found.unresolved.empty());
  EXPECT_GE(measured(found.teeth, 0, 1).of_roots()->mm, 0.499);
  EXPECT_GE(made, 4) << "twice each";
}

TEST(ResolveCollisions, AToothThatCannotBeMadeStays) {
  const Row row = converging_pair();
  const FinishTooth finish = [&](std::size_t i, const RootSteering& steering) {
    if (i == 0) throw NoResultError("No tooth was found.");
    return row.shapes[i].steered(row.fdi[i], steering);
  };
  const ResolvedCollisions found = resolve_collisions(row.roots(), row.teeth(), finish);
  ASSERT_EQ(found.notes.size(), 1U);
  EXPECT_NE(found.notes[0].find("Tooth 35 keeps its root"), std::string::npos) << found.notes[0];
  EXPECT_TRUE(is_unchanged(found.steering[0]));
  EXPECT_TRUE(found.unresolved.empty()) << "the other one gives way";
  EXPECT_GE(measured(found.teeth, 0, 1).of_roots()->mm, 0.499);
}

TEST(ResolveCollisions, TheSameOnOneThread) {
  const Row row = converging_pair();
  const FoundSteering many = find_least_steering(row.roots());
  tbb::task_arena alone(1);
  alone.execute([&] {
    const FoundSteering one = find_least_steering(row.roots());
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_EQ(one.steering[i].tip_degrees, many.steering[i].tip_degrees);
      EXPECT_EQ(one.steering[i].torque_degrees, many.steering[i].torque_degrees);
      EXPECT_EQ(one.steering[i].bend_degrees, many.steering[i].bend_degrees);
      EXPECT_EQ(one.steering[i].length_mm, many.steering[i].length_mm);
    }
  });
}

TEST(ResolveCollisions, RefusesWhatIsOutOfRange) {
  const Row row = converging_pair();
  ResolveOptions options;
  options.search.clearance = 3.5;
  EXPECT_THROW(resolve_collisions(row.roots(), row.teeth(), row.finish(), options), UsageError);
  options.search.clearance = std::nan("");
  EXPECT_THROW(resolve_collisions(row.roots(), row.teeth(), row.finish(), options), UsageError);
  EXPECT_THROW(resolve_collisions(row.roots(), {}, row.finish()), UsageError);
  options = {};
  options.rounds = 0;
  EXPECT_THROW(resolve_collisions(row.roots(), row.teeth(), row.finish(), options), UsageError);
}

}  // namespace
}  // namespace rhizodont
