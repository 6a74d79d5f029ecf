// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "rhizodont/check.hpp"

#include "base/float_bits.hpp"
#include "mesh/adjacency.hpp"
#include "mesh/test_meshes.hpp"
#include "report/json.hpp"
#include "rhizodont/error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

namespace rhizodont {
namespace {

using test::cube, test::grid, test::sphere, test::together, test::torus;

// A ball as the tooth; its crown is all above a height. Coordinates are floats, as from a scanner.
TriangleMesh ball() {
  TriangleMesh mesh = sphere(3, 4);
  for (Point& p : mesh.vertices) p = nearest_float(p);
  return mesh;
}

Submesh cap_of(const TriangleMesh& mesh, double height) {
  std::vector<bool> above;
  for (const Triangle& t : mesh.triangles)
    above.push_back(std::all_of(t.begin(), t.end(),
                                [&](int v) { return mesh.vertices[static_cast<std::size_t>(v)].z() > height; }));
  return submesh(mesh, above);
}

struct Pair {
  TriangleMesh crown, tooth;
  Submesh part;  // where the crown is in the tooth
};

Pair good_pair() {
  Pair pair;
  pair.tooth = ball();
  pair.part = cap_of(pair.tooth, 0.5);
  pair.crown = pair.part.mesh;
  return pair;
}

std::string all_failures(const CheckReport& report) {
  std::string text;
  for (const std::string& failure : report.failures) text += failure + "\n";
  return text;
}

void expect_failure(const CheckReport& report, const std::string& words) {
  EXPECT_FALSE(report.holds());
  EXPECT_NE(all_failures(report).find(words), std::string::npos) << all_failures(report) << "should hold: " << words;
}

// A vertex of the crown that no border triangle touches, as numbered in the crown: the one nearest to the pole.
int pole(const TriangleMesh& crown) {
  int best = 0;
  for (int v = 0; v < static_cast<int>(crown.vertices.size()); ++v)
    if (crown.vertices[static_cast<std::size_t>(v)].z() > crown.vertices[static_cast<std::size_t>(best)].z()) best = v;
  return best;
}

TEST(Check, AToothThatKeepsItsCrownPasses) {
  const Pair pair = good_pair();
  const CheckReport report = check(pair.crown, pair.tooth);
  EXPECT_TRUE(report.holds()) << all_failures(report);
  EXPECT_TRUE(report.failures.empty());
  EXPECT_EQ(report.crown.kept_triangles, static_cast<std::int64_t>(pair.crown.triangles.size()));
  EXPECT_EQ(report.crown.kept_vertices, static_cast<std::int64_t>(pair.crown.vertices.size()));
  EXPECT_EQ(report.crown.kept_share, 1);
  ASSERT_TRUE(report.crown.deviation);
  EXPECT_EQ(report.crown.deviation->max, 0);
  EXPECT_EQ(report.crown.deviation->bins[0], report.crown.vertices);
  EXPECT_EQ(report.new_triangles.all->triangles, pair.tooth.triangles.size() - pair.crown.triangles.size());
  EXPECT_EQ(report.all_triangles->triangles, pair.tooth.triangles.size());
}

TEST(Check, OrderOfVerticesTrianglesAndCornersDoesNotMatter) {
  Pair pair = good_pair();
  std::mt19937 engine(3);
  std::vector<int> place(pair.tooth.vertices.size());
  std::iota(place.begin(), place.end(), 0);
  std::shuffle(place.begin(), place.end(), engine);
  TriangleMesh shuffled{std::vector<Point>(place.size()), pair.tooth.triangles};
  for (std::size_t v = 0; v < place.size(); ++v)
    shuffled.vertices[static_cast<std::size_t>(place[v])] = pair.tooth.vertices[v];
  for (Triangle& t : shuffled.triangles) {
    for (auto& v : t) v = place[static_cast<std::size_t>(v)];
    std::rotate(t.begin(), t.begin() + static_cast<std::ptrdiff_t>(engine() % 3), t.end());
  }
  std::shuffle(shuffled.triangles.begin(), shuffled.triangles.end(), engine);
  const CheckReport report = check(pair.crown, shuffled);
  EXPECT_TRUE(report.holds()) << all_failures(report);
  EXPECT_EQ(report.crown.kept_share, 1);
}

TEST(Check, UnusedCrownVerticesDoNotCount) {
  Pair pair = good_pair();
  pair.crown.vertices.emplace_back(50, 50, 50);
  const CheckReport report = check(pair.crown, pair.tooth);
  EXPECT_TRUE(report.holds());
  EXPECT_TRUE(report.crown.dropped_vertices.empty());
  EXPECT_EQ(report.crown.deviation->max, 0);
}

TEST(Check, AVertexMovedByTheLeastFloatStepIsDroppedNotKept) {
  Pair pair = good_pair();
  const int v = pole(pair.crown);
  double& x = pair.tooth.vertices[static_cast<std::size_t>(pair.part.old_vertices[static_cast<std::size_t>(v)])].x();
  x = static_cast<double>(std::nextafter(static_cast<float>(x), 9.0F));
  const CheckReport report = check(pair.crown, pair.tooth);
  EXPECT_EQ(report.crown.dropped_vertices, std::vector<int>{v});
  const auto around = vertex_triangles(pair.crown);
  const int valence = around.first[static_cast<std::size_t>(v) + 1] - around.first[static_cast<std::size_t>(v)];
  EXPECT_EQ(report.crown.kept_triangles, report.crown.triangles - valence);
  EXPECT_TRUE(report.crown.broken_triangles.empty());
}

TEST(Check, TheLeastDoubleStepCountsUnlessTheToothIsOfFloats) {
  Pair pair = good_pair();
  const int v = pole(pair.crown);
  double& x = pair.tooth.vertices[static_cast<std::size_t>(pair.part.old_vertices[static_cast<std::size_t>(v)])].y();
  x = std::nextafter(x, 9.0);
  const CheckReport exact = check(pair.crown, pair.tooth);
  EXPECT_FALSE(exact.crown.compared_as_float);
  EXPECT_EQ(exact.crown.dropped_vertices, std::vector<int>{v});
  CheckOptions as_float;
  as_float.compare_as_float = true;
  EXPECT_TRUE(check(pair.crown, pair.tooth, as_float).crown.dropped_vertices.empty());
  // a crown of doubles against the tooth that was stored as float
  TriangleMesh wide = sphere(3, 4);
  const CheckReport stored = check(cap_of(wide, 0.5).mesh, ball());
  EXPECT_TRUE(stored.crown.compared_as_float);
  EXPECT_TRUE(stored.holds()) << all_failures(stored);
}

TEST(Check, ZerosOfBothSignsAreEqual) {
  Pair pair = good_pair();
  int changed = 0;
  for (Point& p : pair.tooth.vertices)
    for (double& x : p)
      if (x == 0) x = -0.0, ++changed;
  EXPECT_GT(changed, 0);
  EXPECT_TRUE(check(pair.crown, pair.tooth).holds());
}

TEST(Check, AFlippedEdgeInTheCrownIsBroken) {
  Pair pair = good_pair();
  // triangles t and n of the crown over one edge: put the other diagonal into the tooth
  const auto neighbours = triangle_adjacency(pair.crown).neighbours;
  std::size_t t = 0;
  while (neighbours[t][0] < static_cast<int>(t)) ++t;
  const auto n = static_cast<std::size_t>(neighbours[t][0]);
  Triangle &a = pair.tooth.triangles[static_cast<std::size_t>(pair.part.old_triangles[t])],
           &b = pair.tooth.triangles[static_cast<std::size_t>(pair.part.old_triangles[n])];
  const auto opposite = static_cast<std::size_t>(
      std::find_if(b.begin(), b.end(), [&](int v) { return std::find(a.begin(), a.end(), v) == a.end(); }) - b.begin());
  const int p = a[0], q = a[1], r = a[2], s = b[opposite];
  a = {p, s, r};
  b = {s, q, r};
  const CheckReport report = check(pair.crown, pair.tooth);
  EXPECT_EQ(report.crown.broken_triangles, (std::vector<int>{static_cast<int>(t), static_cast<int>(n)}));
  EXPECT_TRUE(report.crown.dropped_vertices.empty());
  EXPECT_FALSE(report.crown.holds);
  EXPECT_TRUE(report.solid.holds);
  expect_failure(report, "2 triangles of the crown are not in the tooth although all their vertices are");
}

TEST(Check, NewTrianglesAtTheCrownAndBelowAreToldApart) {
  Pair pair = good_pair();
  const std::vector<int>& crown = pair.part.old_vertices;
  const auto is_of_crown = [&](int v) { return std::find(crown.begin(), crown.end(), v) != crown.end(); };
  std::size_t at_border = 0;
  for (const Triangle& t : pair.tooth.triangles)
    at_border += std::any_of(t.begin(), t.end(), is_of_crown) && !std::all_of(t.begin(), t.end(), is_of_crown);
  ASSERT_GT(at_border, 10U);
  // A needle at the lowest vertex, far from the crown.
  const auto lowest = std::min_element(pair.tooth.vertices.begin(), pair.tooth.vertices.end(),
                                       [](const Point& a, const Point& b) { return a.z() < b.z(); }) -
                      pair.tooth.vertices.begin();
  const auto at_lowest = std::find_if(pair.tooth.triangles.begin(), pair.tooth.triangles.end(), [&](const Triangle& t) {
    return std::find(t.begin(), t.end(), lowest) != t.end();
  });
  ASSERT_NE(at_lowest, pair.tooth.triangles.end());
  const Point other = pair.tooth.vertices[static_cast<std::size_t>((*at_lowest)[at_lowest->front() == lowest ? 1 : 0])];
  Point& needle = pair.tooth.vertices[static_cast<std::size_t>(lowest)];
  needle += 0.9 * (other - needle);
  const NewTriangleFigures figures = check(pair.crown, pair.tooth).new_triangles;
  ASSERT_TRUE(figures.all && figures.inner && figures.at_border);
  EXPECT_EQ(figures.at_border->triangles, at_border);
  EXPECT_EQ(figures.inner->triangles + figures.at_border->triangles, figures.all->triangles);
  EXPECT_LT(figures.inner->theta_min, 10);
  EXPECT_GT(figures.at_border->theta_min, 30);
}

TEST(Check, AMirroredTriangleIsBroken) {
  Pair pair = good_pair();
  Triangle& t = pair.tooth.triangles[static_cast<std::size_t>(pair.part.old_triangles[7])];
  std::swap(t[0], t[2]);
  const CheckReport report = check(pair.crown, pair.tooth);
  EXPECT_EQ(report.crown.broken_triangles, std::vector<int>{7});
  EXPECT_EQ(report.solid.misoriented_edges, 3);
  EXPECT_FALSE(report.solid.holds);
}

TEST(Check, ASteinerPointInACrownTriangleIsBroken) {
  Pair pair = good_pair();
  Triangle& t = pair.tooth.triangles[static_cast<std::size_t>(pair.part.old_triangles[5])];
  const Triangle old = t;
  Point middle = Point::Zero();
  for (const int v : old) middle += pair.tooth.vertices[static_cast<std::size_t>(v)] / 3;
  const auto m = static_cast<std::int32_t>(pair.tooth.vertices.size());
  pair.tooth.vertices.push_back(nearest_float(middle));
  t = {old[0], old[1], m};
  pair.tooth.triangles.push_back({old[1], old[2], m});
  pair.tooth.triangles.push_back({old[2], old[0], m});
  const CheckReport report = check(pair.crown, pair.tooth);
  EXPECT_EQ(report.crown.broken_triangles, std::vector<int>{5});
  EXPECT_TRUE(report.solid.holds);
}

TEST(Check, AVertexMergedAcrossASeamHasAnotherOneInItsPlace) {
  Pair pair = good_pair();
  const int v = pole(pair.crown);
  const auto copy = static_cast<std::int32_t>(pair.crown.vertices.size());
  const Point beside = pair.crown.vertices[static_cast<std::size_t>(v)] + Point(0, 0, 0x1p-10);
  pair.crown.vertices.push_back(beside);
  std::vector<int> moved;  // every other triangle around v is on the other side of a seam
  for (std::size_t t = 0; t < pair.crown.triangles.size(); ++t) {
    Triangle& triangle = pair.crown.triangles[t];
    const auto at = std::find(triangle.begin(), triangle.end(), v);
    if (at == triangle.end() || t % 2 == 0) continue;
    *at = copy;
    moved.push_back(static_cast<int>(t));
  }
  ASSERT_FALSE(moved.empty());
  CheckOptions options = allowing_for({RepairStep{RepairAction::seam_merged, {copy}, {}, {v}}});
  CheckReport report = check(pair.crown, pair.tooth, options);
  EXPECT_TRUE(report.holds()) << all_failures(report);
  EXPECT_EQ(report.crown.kept_triangles, static_cast<std::int64_t>(pair.crown.triangles.size()));
  EXPECT_EQ(report.crown.merged_vertices, 1);
  EXPECT_DOUBLE_EQ(report.crown.merged_distance_max, 0x1p-10);
  // The triangles are demanded all the same, with the other vertex.
  std::swap(
      pair.tooth
          .triangles[static_cast<std::size_t>(pair.part.old_triangles[static_cast<std::size_t>(moved.front())])][0],
      pair.tooth
          .triangles[static_cast<std::size_t>(pair.part.old_triangles[static_cast<std::size_t>(moved.front())])][1]);
  EXPECT_EQ(check(pair.crown, pair.tooth, options).crown.broken_triangles, std::vector<int>{moved.front()});
  options.merged_vertices.front()[1] = copy + 1;
  EXPECT_THROW(check(pair.crown, pair.tooth, options), UsageError);
}

TEST(Check, SomethingMustBeKept) {
  const Pair pair = good_pair();
  TriangleMesh elsewhere = pair.crown;
  for (Point& p : elsewhere.vertices) p += Point(0.125, 0, 0);
  const CheckReport report = check(elsewhere, pair.tooth);
  EXPECT_TRUE(report.crown.broken_triangles.empty());
  EXPECT_EQ(report.crown.kept_triangles, 0);
  EXPECT_GT(report.crown.deviation->max, 0.01);
  expect_failure(report, "no triangle of the crown is in the tooth");
  CheckOptions lenient;
  lenient.least_kept_share = 0;
  EXPECT_FALSE(check(elsewhere, pair.tooth, lenient).holds());
}

TEST(Check, TheLeastShareIsAnOption) {
  // the crown has a skirt of twice as many triangles that the tooth does not keep
  const Pair pair = good_pair();
  const TriangleMesh skirted = together(pair.crown, grid(16), {30, 0, 0});
  const double share = static_cast<double>(pair.crown.triangles.size()) / static_cast<double>(skirted.triangles.size());
  CheckOptions options;
  options.least_kept_share = share;
  const CheckReport report = check(skirted, pair.tooth, options);
  EXPECT_TRUE(report.holds()) << all_failures(report);
  EXPECT_EQ(report.crown.dropped_vertices.size(), 17U * 17U);
  EXPECT_EQ(report.crown.dropped_vertices.front(), static_cast<int>(pair.crown.vertices.size()));
  options.least_kept_share = std::nextafter(share, 1.0);
  expect_failure(check(skirted, pair.tooth, options), "% of the crown's triangles are in the tooth");
  options.least_kept_share = 1.5;
  EXPECT_THROW(check(skirted, pair.tooth, options), UsageError);
}

TEST(Check, WhatTheReportListsAsDroppedIsNotDemanded) {
  const Pair pair = good_pair();
  const TriangleMesh skirted = together(pair.crown, grid(16), {30, 0, 0});
  CheckOptions options;
  options.least_kept_share = 1;
  EXPECT_FALSE(check(skirted, pair.tooth, options).holds());
  for (std::size_t v = pair.crown.vertices.size(); v < skirted.vertices.size(); ++v)
    options.dropped_vertices.push_back(static_cast<int>(v));
  const CheckReport report = check(skirted, pair.tooth, options);
  EXPECT_TRUE(report.holds()) << all_failures(report);
  EXPECT_EQ(report.crown.demanded_triangles, static_cast<std::int64_t>(pair.crown.triangles.size()));
  EXPECT_EQ(report.crown.triangles, static_cast<std::int64_t>(skirted.triangles.size()));
  // what is not listed stays demanded
  options.dropped_vertices.resize(options.dropped_vertices.size() / 2);
  expect_failure(check(skirted, pair.tooth, options), "% of the crown's triangles are in the tooth");
  options.dropped_vertices = {static_cast<int>(skirted.vertices.size())};
  EXPECT_THROW(check(skirted, pair.tooth, options), UsageError);
}

TEST(Check, DeviationFallsIntoTheBinsOfTable3) {
  // points above the middle of the top face of a cube, at known distances
  TriangleMesh crown;
  for (const double height : {0.0, 0.0005, 0.005, 0.05, 0.5, 0.25})
    crown.vertices.emplace_back(0.5 + height / 4, 0.5, 1 + height);
  crown.triangles = {{0, 1, 2}, {3, 4, 5}};
  const CheckReport report = check(crown, cube());
  EXPECT_EQ(report.crown.deviation->bins, (std::array<std::int64_t, 4>{2, 1, 1, 2}));
  EXPECT_NEAR(report.crown.deviation->max, 0.5, 1e-12);
  EXPECT_NEAR(report.crown.deviation->mean, (0.0005 + 0.005 + 0.05 + 0.5 + 0.25) / 6, 1e-12);
}

TEST(CheckSolid, EachDefectIsFound) {
  const Pair good = good_pair();
  const std::size_t root = 0;  // a triangle of the tooth outside the crown
  std::size_t root_triangle = root;
  while (std::binary_search(good.part.old_triangles.begin(), good.part.old_triangles.end(),
                            static_cast<int>(root_triangle)))
    ++root_triangle;
  const auto broken = [&](const auto& change) {
    TriangleMesh tooth = good.tooth;
    change(tooth);
    const CheckReport report = check(good.crown, tooth);
    EXPECT_TRUE(report.crown.holds) << all_failures(report);
    EXPECT_FALSE(report.solid.holds);
    return report;
  };
  expect_failure(broken([&](TriangleMesh& m) {
                   m.triangles.erase(m.triangles.begin() + static_cast<std::ptrdiff_t>(root_triangle));
                 }),
                 "open: 3 border edges");
  expect_failure(
      broken([&](TriangleMesh& m) { std::swap(m.triangles[root_triangle][0], m.triangles[root_triangle][1]); }),
      "face opposite ways");
  expect_failure(broken([&](TriangleMesh& m) { m.triangles.push_back(m.triangles[root_triangle]); }), "there twice");
  expect_failure(broken([](TriangleMesh& m) { m.vertices.emplace_back(0, 0, 0); }), "1 vertices that no triangle uses");
  expect_failure(broken([](TriangleMesh& m) { m = together(m, cube(), {20, 0, 0}); }), "2 pieces");
  expect_failure(broken([&](TriangleMesh& m) { m.triangles[root_triangle][1] = 1 << 20; }), "do not exist");
  expect_failure(broken([&](TriangleMesh& m) { m.triangles[root_triangle][1] = m.triangles[root_triangle][0]; }),
                 "same vertex twice");
  expect_failure(
      broken([](TriangleMesh& m) { m.vertices.emplace_back(std::numeric_limits<double>::quiet_NaN(), 0, 0); }),
      "not finite");
  // the south pole is pushed out through the north
  const CheckReport pierced = broken([](TriangleMesh& m) { m.vertices[5].z() = 4.5; });
  expect_failure(pierced, "cuts itself");
  EXPECT_FALSE(pierced.solid.self_intersections.empty());
  EXPECT_EQ(pierced.solid.border_edges, 0);
}

TEST(CheckSolid, InsideOutAndHandles) {
  const TriangleMesh turned = flipped(ball());
  const CheckReport inside_out = check(cap_of(turned, 0.5).mesh, turned);
  EXPECT_TRUE(inside_out.crown.holds);
  expect_failure(inside_out, "inside out");
  const TriangleMesh ring = torus(30, 20);
  const CheckReport handle = check(cap_of(ring, 0.1).mesh, ring);
  EXPECT_TRUE(handle.crown.holds);
  expect_failure(handle, "1 handles");
  EXPECT_EQ(handle.solid.genus, 1);
}

TEST(CheckSolid, AToothWithoutTrianglesFailsWithoutThrowing) {
  const CheckReport report = check(good_pair().crown, {});
  expect_failure(report, "the tooth has no triangles");
  EXPECT_FALSE(report.crown.deviation);
  EXPECT_FALSE(report.new_triangles.all);
  EXPECT_FALSE(report.new_triangles.holds());
  EXPECT_TRUE(nlohmann::ordered_json(report)["crown"]["deviation"].is_null());
}

TEST(Check, ABadCrownIsAnInputError) {
  const Pair pair = good_pair();
  EXPECT_THROW(check({}, pair.tooth), InputError);
  TriangleMesh crown = pair.crown;
  crown.triangles[0][0] = -1;
  EXPECT_THROW(check(crown, pair.tooth), InputError);
  crown = pair.crown;
  crown.vertices[0].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(check(crown, pair.tooth), InputError);
}

}  // namespace
}  // namespace rhizodont
