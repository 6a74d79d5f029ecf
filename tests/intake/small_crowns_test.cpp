// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// A dome of which it is known what is crown and what is not: every number that the intake gives can be told beforehand.

#include "common/closed_bases.hpp"
#include "intake/closed_crown.hpp"
#include "intake/take_crown.hpp"
#include "mesh/diagnosis.hpp"
#include "mesh/geometry.hpp"
#include "mesh/test_meshes.hpp"
#include "pipeline/models.hpp"
#include "pipeline/product_models.hpp"
#include "rhizodont/error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <random>

namespace rhizodont {
namespace {

using test::models;

/// 8 mm across, its border on z = 0.
TriangleMesh dome() { return test::dome(3, 4); }

const Atlas& atlas() { return content_of(models())->atlas; }

TakenCrown taken_of(const TriangleMesh& crown, const CompleteOptions& options = test::for_tooth(36)) {
  return take_crown(crown, atlas(), std::nullopt, options);
}

std::vector<int> counted_from(int first, std::size_t count) {
  std::vector<int> numbers(count);
  std::iota(numbers.begin(), numbers.end(), first);
  return numbers;
}

/// The refusal of a crown: what it says and the elements it names.
InputError refusal(const TriangleMesh& crown, const CompleteOptions& options = test::for_tooth(36)) {
  try {
    const TakenCrown taken = taken_of(crown, options);
  } catch (const InputError& error) {
    return error;
  }
  ADD_FAILURE() << "was taken";
  return InputError("nothing");
}

void expect_says(const InputError& error, const std::string& words) {
  EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
}

TEST(TakeCrown, AnOpenCrownIsTakenAsItIs) {
  const TakenCrown taken = taken_of(dome());
  EXPECT_EQ(taken.kept.mesh.vertices, dome().vertices);
  EXPECT_EQ(taken.kept.mesh.triangles, dome().triangles);
  EXPECT_EQ(taken.kept.old_vertices, counted_from(0, dome().vertices.size()));
  EXPECT_EQ(taken.kept.old_triangles, counted_from(0, dome().triangles.size()));
  EXPECT_TRUE(taken.kept.dropped.empty());
  EXPECT_TRUE(taken.record.repairs.empty());
  EXPECT_TRUE(taken.record.tooth_confidence.empty());
  EXPECT_FALSE(taken.record.cap_dropped);
}

TEST(TakeCrown, UnitsAreBroughtToMillimetres) {
  TriangleMesh crown = dome();
  for (Point& p : crown.vertices) p *= 1.0 / 128;
  CompleteOptions options = test::for_tooth(36);
  expect_says(refusal(crown), "0.0625 mm across");
  options.millimetres_per_unit = 128;
  EXPECT_EQ(taken_of(crown, options).kept.mesh.vertices, dome().vertices) << "powers of two round nothing";
}

TEST(TakeCrown, NumbersAreTheInputsAlsoBehindWhatIsDropped) {
  // A speck and a stray vertex before the crown, behind it a triangle that hangs on one vertex.
  const TriangleMesh speck{{{30, 0, 0}, {30.1, 0, 0}, {30, 0.1, 0}}, {{0, 1, 2}}};
  TriangleMesh crown = test::together(speck, dome(), Eigen::Vector3d::Zero());
  crown.vertices.insert(crown.vertices.begin() + 3, Point(40, 0, 0));
  for (std::size_t t = 1; t < crown.triangles.size(); ++t)
    for (std::int32_t& v : crown.triangles[t]) ++v;
  const auto border = static_cast<std::int32_t>(std::find_if(crown.vertices.begin() + 4, crown.vertices.end(),
                                                             [](const Point& p) { return std::abs(p.z()) < 1e-9; }) -
                                                crown.vertices.begin());
  const auto last = static_cast<std::int32_t>(crown.vertices.size());
  const Point at_border = crown.vertices[static_cast<std::size_t>(border)];
  crown.vertices.emplace_back(at_border + Point(0, 0.3, -1));
  crown.vertices.emplace_back(at_border + Point(0, -0.3, -1));
  crown.triangles.push_back({border, last, last + 1});
  const TakenCrown taken = taken_of(crown);
  EXPECT_EQ(taken.kept.old_triangles, counted_from(1, dome().triangles.size()));
  ASSERT_EQ(taken.record.repairs.size(), 1U);
  EXPECT_EQ(taken.record.repairs[0].action, RepairAction::speck_dropped);
  EXPECT_EQ(taken.record.repairs[0].vertices, (std::vector<int>{0, 1, 2, last, last + 1}));
  std::map<int, DropReason> dropped;
  for (const DroppedCrownVertex& d : taken.kept.dropped) dropped[d.vertex] = d.reason;
  EXPECT_EQ(dropped[3], DropReason::unreferenced);
  for (const int v : {0, 1, 2, last, last + 1}) EXPECT_EQ(dropped[v], DropReason::repair) << v;
  EXPECT_EQ(dropped.size(), 6U);
  EXPECT_EQ(taken.kept.old_vertices, counted_from(4, dome().vertices.size()));
}

TEST(TakeCrown, ANewNumberingOrAMotionTakesTheSame) {
  TriangleMesh crown = dome();
  crown.vertices.emplace_back(0, 0, -9);  // stray
  std::vector<int> order = counted_from(0, crown.vertices.size());
  std::shuffle(order.begin(), order.end(), std::mt19937(4));
  TriangleMesh other = crown;
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(2.1, Eigen::Vector3d(1, 1, -2).normalized()).toRotationMatrix();
  for (std::size_t v = 0; v < order.size(); ++v)
    other.vertices[static_cast<std::size_t>(order[v])] = turn * crown.vertices[v] + Point(10, 20, -5);
  for (Triangle& t : other.triangles)
    for (std::int32_t& v : t) v = order[static_cast<std::size_t>(v)];
  std::reverse(other.triangles.begin(), other.triangles.end());
  const TakenCrown taken = taken_of(other);
  ASSERT_EQ(taken.kept.dropped.size(), 1U);
  EXPECT_EQ(taken.kept.dropped[0].vertex, order.back());
  EXPECT_EQ(taken.kept.old_vertices.size(), dome().vertices.size());
  EXPECT_EQ(taken.kept.old_triangles.size(), dome().triangles.size());
}

TEST(TakeCrown, AMadeCapIsTakenOffToTheTriangle) {
  for (const char* kind : {"fan", "cone", "block"})
    for (const std::uint64_t seed : {0, 7}) {
      SCOPED_TRACE(std::string(kind) + " " + std::to_string(seed));
      const test::ClosedCrown closed = test::closed_base(test::dome(4, 4), kind, seed);
      const TakenCrown taken = taken_of(closed.mesh);
      EXPECT_TRUE(taken.record.cap_dropped);
      std::vector<int> crown;
      for (std::size_t t = 0; t < closed.is_cap.size(); ++t)
        if (!closed.is_cap[t]) crown.push_back(static_cast<int>(t));
      EXPECT_EQ(taken.kept.old_triangles, crown);
      for (const DroppedCrownVertex& d : taken.kept.dropped) EXPECT_EQ(d.reason, DropReason::cap);
      EXPECT_EQ(taken.kept.old_vertices.size() + taken.kept.dropped.size(), closed.mesh.vertices.size());
    }
}

TEST(TakeCrown, WhatCannotBeTakenIsNamedInTheInputsNumbers) {
  TriangleMesh crown = dome();
  crown.vertices.insert(crown.vertices.begin(), Point(50, 0, 0));  // stray, and all numbers are one more
  for (Triangle& t : crown.triangles)
    for (std::int32_t& v : t) ++v;
  const TriangleMesh good = crown;

  crown.vertices[8].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(refusal(crown).elements(), std::vector<std::int64_t>{8});
  EXPECT_EQ(refusal(crown).kind(), ElementKind::vertices);

  crown = good;
  crown.triangles[5][2] = 100000;
  EXPECT_EQ(refusal(crown).elements(), std::vector<std::int64_t>{5});
  EXPECT_EQ(refusal(crown).kind(), ElementKind::triangles);

  crown = good;
  std::swap(crown.triangles[9][0], crown.triangles[9][1]);
  expect_says(refusal(crown), "flipped against their neighbours");
  EXPECT_EQ(refusal(crown).kind(), ElementKind::vertex_pairs);
  const Triangle& turned = crown.triangles[9];
  const InputError flips = refusal(crown);
  for (const std::int64_t v : flips.elements())
    EXPECT_EQ(std::count(turned.begin(), turned.end(), static_cast<std::int32_t>(v)), 1) << v;

  crown = good;
  const auto fin = static_cast<std::int32_t>(crown.vertices.size());
  crown.vertices.emplace_back(0, 0, 6);
  crown.triangles.push_back({good.triangles[3][0], good.triangles[3][1], fin});
  expect_says(refusal(crown), "more than two triangles");
  EXPECT_EQ(refusal(crown).elements(),
            (std::vector<std::int64_t>{std::min(good.triangles[3][0], good.triangles[3][1]),
                                       std::max(good.triangles[3][0], good.triangles[3][1])}));

  crown = good;
  const auto top = std::max_element(crown.vertices.begin() + 1, crown.vertices.end(),
                                    [](const Point& a, const Point& b) { return a.z() < b.z(); });
  *top = Point(5, 0.1, 1);  // through the side
  const InputError cuts = refusal(crown);
  EXPECT_EQ(cuts.kind(), ElementKind::triangle_pairs);
  const auto number = static_cast<std::int32_t>(top - crown.vertices.begin());
  for (std::size_t i = 0; i + 1 < cuts.elements().size(); i += 2) {
    const Triangle &a = crown.triangles[static_cast<std::size_t>(cuts.elements()[i])],
                   &b = crown.triangles[static_cast<std::size_t>(cuts.elements()[i + 1])];
    EXPECT_GT(std::count(a.begin(), a.end(), number) + std::count(b.begin(), b.end(), number), 0)
        << "one of the two was moved";
  }

  expect_says(refusal(flipped(good)), "inside out");
  expect_says(refusal({}), "no triangles");
  expect_says(refusal(test::together(dome(), dome(), {10, 0, 0})), "2 crowns");
}

TEST(TakeCrown, OptionsThatCannotBeMet) {
  CompleteOptions keep = test::for_tooth(36);
  keep.cap = CapHandling::keep;
  expect_says(refusal(test::closed_base(dome(), "fan").mesh, keep), "its cap was to be kept");
  EXPECT_NO_THROW(taken_of(dome(), keep)) << "it has none";
  CompleteOptions skirt = test::for_tooth(36);
  skirt.skirt = 0.5;
  EXPECT_THROW(taken_of(dome(), skirt), UsageError) << "no network to find it with";
}

/// The dome closed by a cap as a modelling program smooths it: a bulging net of irregular triangles.
test::ClosedCrown smoothly_closed() {
  const TriangleMesh crown = test::dome(4, 4);
  test::ClosedCrown closed{crown, std::vector<bool>(crown.triangles.size(), false)};
  // The lower half of the same ball, pressed flat; its inner vertices moved a little.
  TriangleMesh lower = test::dome(4, 4);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> wobble(-0.04, 0.04);
  std::vector<std::int32_t> number;
  for (const Point& p : lower.vertices) {
    const double r = std::hypot(p.x(), p.y());
    if (p.z() < 1e-9) {
      const auto same = std::find(crown.vertices.begin(), crown.vertices.end(), p);
      number.push_back(static_cast<std::int32_t>(same - crown.vertices.begin()));
      continue;
    }
    // By angle from the pole, so that triangles stay of like size.
    const double polar = std::atan2(r, p.z()) / (std::acos(-1.0) / 2);
    const double out = r > 0 ? 4 * polar / r : 0;
    number.push_back(static_cast<std::int32_t>(closed.mesh.vertices.size()));
    closed.mesh.vertices.emplace_back(out * p.x() + wobble(random), out * p.y() + wobble(random),
                                      -0.2 * (1 - polar * polar) + 0.2 * wobble(random));
  }
  for (const Triangle& t : lower.triangles) {
    closed.mesh.triangles.push_back({number[static_cast<std::size_t>(t[0])], number[static_cast<std::size_t>(t[2])],
                                     number[static_cast<std::size_t>(t[1])]});
    closed.is_cap.push_back(true);
  }
  return closed;
}

TEST(RecogniseCap, ByItsForm) {
  const test::ClosedCrown closed = smoothly_closed();
  ASSERT_TRUE(diagnose(closed.mesh).is_closed_solid());
  for (const std::optional<int> fdi : {std::optional<int>(36), std::optional<int>()}) {
    const Cap cap = recognise_cap(closed.mesh, atlas(), fdi);
    EXPECT_FALSE(cap.made);
    EXPECT_EQ(cap.is_cap, closed.is_cap);
    EXPECT_EQ(cap.triangles, std::count(closed.is_cap.begin(), closed.is_cap.end(), true));
    EXPECT_LT(cap.direction.z(), -0.99);
    EXPECT_NEAR(cap.share, 1, 0.02) << "as wide as the dome";
  }
}

TEST(RecogniseCap, TurnedInSpaceItIsTheSame) {
  test::ClosedCrown closed = smoothly_closed();
  for (const double angle : {0.7, 1.9, 3.0}) {
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(angle, Eigen::Vector3d(2, 1, -1).normalized()).toRotationMatrix();
    TriangleMesh turned = closed.mesh;
    for (Point& p : turned.vertices) p = turn * p + Point(-3, 8, 40);
    const Cap cap = recognise_cap(turned, atlas(), 36);
    EXPECT_EQ(cap.is_cap, closed.is_cap) << angle;
    EXPECT_LT((turn.transpose() * cap.direction).z(), -0.99) << angle;
  }
}

TEST(RecogniseCap, AMadeOneIsKnownByItsTriangles) {
  const test::ClosedCrown closed = test::closed_base(test::dome(4, 4), "fan", 3);
  const Cap cap = recognise_cap(closed.mesh, atlas(), std::nullopt);
  EXPECT_TRUE(cap.made);
  EXPECT_EQ(cap.is_cap, closed.is_cap);
  EXPECT_NEAR(cap.direction.z(), -1, 1e-9);
  EXPECT_NEAR(cap.flatness, 1, 1e-9);
}

TEST(RecogniseCap, ABallHasNone) {
  EXPECT_THROW(recognise_cap(test::sphere(4, 4), atlas(), 36), InputError);
  EXPECT_THROW(recognise_cap(test::sphere(4, 4), atlas(), std::nullopt), InputError);
  // What is as long as a whole tooth is told so.
  TriangleMesh egg = test::sphere(4, 4);
  for (Point& p : egg.vertices) p.z() *= 2.75;
  try {
    recognise_cap(egg, atlas(), 11);
    FAIL() << "was recognised";
  } catch (const InputError& error) {
    expect_says(error, "22 mm long");
  }
}

}  // namespace
}  // namespace rhizodont
