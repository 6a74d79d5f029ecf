// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "mesh/repair.hpp"

#include "mesh/diagnosis.hpp"
#include "mesh/geometry.hpp"
#include "mesh/self_intersection.hpp"
#include "mesh/test_meshes.hpp"
#include "rhizodont/error.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <string>

namespace rhizodont {
namespace {

TriangleMesh crown() { return test::dome(3, 4); }

std::int32_t last_vertex(const TriangleMesh& mesh) { return static_cast<std::int32_t>(mesh.vertices.size()) - 1; }

/// The step with this word in its action; fails the test if there is none.
RepairStep step(const RepairedMesh& repaired, const std::string& word) {
  for (const RepairStep& s : repaired.steps)
    if (action_text(s).find(word) != std::string::npos) return s;
  ADD_FAILURE() << "no step says " << word;
  return {};
}

/// As the clean dome: the same surface with one border.
void expect_dome(const RepairedMesh& repaired) {
  const Diagnosis d = diagnose(repaired.mesh);
  EXPECT_TRUE(d.is_oriented_manifold());
  EXPECT_EQ(d.border_loop_count, 1);
  EXPECT_NEAR(surface_area(repaired.mesh), surface_area(crown()), 1e-9);
  EXPECT_GT(cone_volume(repaired.mesh), 0);
}

TEST(Repair, ACleanCrownStaysAsItIs) {
  const RepairedMesh repaired = repair(crown());
  EXPECT_TRUE(repaired.steps.empty());
  EXPECT_EQ(repaired.mesh.triangles, crown().triangles);
  EXPECT_EQ(repaired.mesh.vertices, crown().vertices);
}

TEST(Repair, CornersOfTheirOwnBecomeOne) {
  TriangleMesh mesh = crown();
  for (Triangle& t : mesh.triangles)
    for (std::int32_t& v : t) {
      mesh.vertices.push_back(Point(mesh.vertices[static_cast<std::size_t>(v)]));
      v = last_vertex(mesh);
    }
  const RepairedMesh repaired = repair(mesh);
  expect_dome(repaired);
  EXPECT_EQ(repaired.steps.size(), 1U);
  EXPECT_EQ(step(repaired, "same place").vertices.size(), 3 * crown().triangles.size()) << "the unused first ones stay";
}

TEST(Repair, TrianglesThereTwiceOrWithoutAreaGo) {
  TriangleMesh mesh = crown();
  const Triangle t = mesh.triangles[5];
  const int first_new = static_cast<int>(mesh.triangles.size());
  mesh.triangles.push_back({t[1], t[2], t[0]});
  mesh.triangles.push_back({t[0], t[2], t[1]});
  mesh.triangles.push_back({t[0], t[1], t[0]});
  const RepairedMesh repaired = repair(mesh);
  expect_dome(repaired);
  EXPECT_EQ(step(repaired, "twice").triangles, (std::vector<int>{first_new, first_new + 2}));
  EXPECT_EQ(step(repaired, "inward copy").triangles, std::vector<int>{first_new + 1});
}

TEST(Repair, ATJunctionIsClosedWithoutMovingTheSurface) {
  TriangleMesh mesh = crown();
  const TriangleAdjacency adjacency = triangle_adjacency(mesh);
  std::size_t t = 0;
  while (adjacency.neighbours[t][0] < 0) ++t;
  const auto [a, b, c] = mesh.triangles[t];
  // Two vertices on one side of the edge.
  const Point p = mesh.vertices[static_cast<std::size_t>(a)], q = mesh.vertices[static_cast<std::size_t>(b)];
  mesh.vertices.push_back(0.75 * p + 0.25 * q);
  mesh.vertices.push_back(0.25 * p + 0.75 * q);
  const std::int32_t n = last_vertex(mesh), m = n - 1;
  mesh.triangles[t] = {a, m, c};
  mesh.triangles.push_back({m, n, c});
  mesh.triangles.push_back({n, b, c});
  ASSERT_EQ(diagnose(mesh).border_loop_count, 2);
  const RepairedMesh repaired = repair(mesh);
  expect_dome(repaired);
  EXPECT_EQ(step(repaired, "T-junction").triangles, std::vector<int>{adjacency.neighbours[t][0]});
}

TEST(Repair, AFinOnAnEdgeGoesAndTheCrownStays) {
  TriangleMesh mesh = crown();
  mesh.vertices.emplace_back(0, 0, 9);
  const Triangle t = mesh.triangles[7];
  mesh.triangles.push_back({t[0], t[1], last_vertex(mesh)});
  const RepairedMesh repaired = repair(mesh);
  expect_dome(repaired);
  EXPECT_EQ(step(repaired, "more than two").vertices, std::vector<int>{last_vertex(mesh)});
}

TEST(Repair, AChordBetweenVerticesOfTheCrownIsListedAsATriangle) {
  TriangleMesh mesh = crown();
  mesh.triangles.push_back({0, 20, 40});
  const RepairedMesh repaired = repair(mesh);
  expect_dome(repaired);
  const RepairStep s = step(repaired, "speck");
  EXPECT_TRUE(s.vertices.empty());
  EXPECT_EQ(s.triangles, std::vector<int>{static_cast<int>(mesh.triangles.size()) - 1});
}

TEST(Repair, ThePieceWithTheLargestAreaStays) {
  // The small piece has more triangles.
  const TriangleMesh mesh = test::together(test::dome(4, 0.5), crown(), Point(9, 0, 0));
  const RepairedMesh repaired = repair(mesh);
  expect_dome(repaired);
  EXPECT_EQ(step(repaired, "separate piece").vertices.size(), test::dome(4, 0.5).vertices.size());
  EXPECT_EQ(repaired.old_vertices.front(), static_cast<int>(test::dome(4, 0.5).vertices.size()));
}

/// What is said where the repair refuses.
std::string refusal(const TriangleMesh& mesh) {
  try {
    repair(mesh);
  } catch (const InputError& error) {
    return error.what();
  }
  return "not refused";
}

TEST(Repair, APieceOfLikeSizeIsNeverDropped) {
  EXPECT_NE(refusal(test::together(crown(), crown(), Point(9, 0, 0))).find("2 crowns"), std::string::npos);
  // Also where the two share an edge that they crowd.
  TriangleMesh mesh = test::together(crown(), crown(), Point(9, 0, 0));
  const auto offset = static_cast<std::int32_t>(crown().vertices.size());
  const Triangle t = crown().triangles[7], u = crown().triangles[90];
  for (Triangle& triangle : mesh.triangles)
    for (std::int32_t& v : triangle) {
      if (v == u[0] + offset) v = t[0];
      if (v == u[1] + offset) v = t[1];
    }
  EXPECT_NE(refusal(mesh).find("2 crowns"), std::string::npos);
}

TEST(Repair, ADoubleSidedCrownKeepsItsOuterSide) {
  const TriangleMesh once = crown();
  TriangleMesh mesh = flipped(once);
  mesh.triangles.insert(mesh.triangles.end(), once.triangles.begin(), once.triangles.end());
  const RepairedMesh repaired = repair(mesh);
  EXPECT_EQ(repaired.mesh.triangles, once.triangles);
  ASSERT_EQ(repaired.steps.size(), 1U);
  EXPECT_EQ(repaired.steps[0].triangles.size(), once.triangles.size());
  EXPECT_EQ(repaired.steps[0].triangles.back(), static_cast<int>(once.triangles.size()) - 1) << "the inward ones";
}

TEST(Repair, ASeamIsMergedAndListed) {
  const TriangleMesh once = crown();
  TriangleMesh mesh = once;
  const std::size_t first_new = mesh.vertices.size();
  std::map<int, int> other_side;  // all triangles right of x = 0 get vertices of their own there
  for (Triangle& t : mesh.triangles) {
    double x = 0;
    for (const int v : t) x += once.vertices[static_cast<std::size_t>(v)].x();
    if (x < 0) continue;
    for (std::int32_t& v : t) {
      const Point p = once.vertices[static_cast<std::size_t>(v)];
      if (std::abs(p.x()) > 1e-9) continue;
      const auto [place, fresh] = other_side.try_emplace(v, static_cast<int>(mesh.vertices.size()));
      if (fresh) mesh.vertices.push_back(p + Point(0, 0, 2e-3));
      v = place->second;
    }
  }
  const RepairedMesh repaired = repair(mesh);
  EXPECT_EQ(repaired.mesh.triangles, once.triangles);
  EXPECT_EQ(repaired.mesh.vertices, once.vertices);
  const RepairStep s = step(repaired, "seam, the farthest 0.002 mm apart");
  EXPECT_EQ(s.vertices.size(), mesh.vertices.size() - first_new);
  ASSERT_EQ(s.merged_into.size(), s.vertices.size());
  for (std::size_t k = 0; k < s.vertices.size(); ++k) EXPECT_EQ(other_side.at(s.merged_into[k]), s.vertices[k]);
}

TEST(Repair, TrianglesAreTurnedAsMostOfTheirPieceAndOutward) {
  TriangleMesh mesh = crown();
  for (const std::size_t t : {3U, 4U, 50U}) std::swap(mesh.triangles[t][0], mesh.triangles[t][1]);
  RepairedMesh repaired = repair(mesh);
  expect_dome(repaired);
  EXPECT_EQ(step(repaired, "turned").triangles, (std::vector<int>{3, 4, 50}));
  repaired = repair(flipped(crown()));
  expect_dome(repaired);
  EXPECT_EQ(step(repaired, "turned").triangles.size(), crown().triangles.size());
}

TEST(Repair, ASpikeGoesAndACuspStays) {
  TriangleMesh mesh = crown();
  std::size_t top = 0;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    if (mesh.vertices[v].z() > mesh.vertices[top].z()) top = v;
  mesh.vertices[top] *= 1.15;
  EXPECT_TRUE(repair(mesh).steps.empty());
  mesh.vertices[top] *= 1.8;
  const RepairedMesh repaired = repair(mesh);
  EXPECT_EQ(step(repaired, "spike").vertices, std::vector<int>{static_cast<int>(top)});
  EXPECT_TRUE(diagnose(repaired.mesh).is_oriented_manifold());
}

TEST(Repair, CutsAreTakenOutUnlessTheyAreEverywhere) {
  TriangleMesh mesh = test::dome(4, 4);
  const Triangle t = mesh.triangles[200];
  std::swap(mesh.vertices[static_cast<std::size_t>(t[0])], mesh.vertices[static_cast<std::size_t>(t[1])]);
  ASSERT_FALSE(self_intersecting_triangles(mesh).empty());
  const RepairedMesh repaired = repair(mesh);
  EXPECT_TRUE(self_intersecting_triangles(repaired.mesh).empty());
  EXPECT_GT(repaired.mesh.triangles.size(), 0.9 * static_cast<double>(mesh.triangles.size()));
  // A crown inside itself from top to bottom is left to be refused.
  TriangleMesh twice = test::together(test::dome(3, 4), test::dome(3, 4), Point(0.01, 0.02, 0));
  const std::int32_t shift = static_cast<std::int32_t>(crown().vertices.size());
  const auto loop = border_loops(crown()).front();
  twice.triangles.push_back({loop[1], loop[0], loop[0] + shift});
  twice.triangles.push_back({loop[0] + shift, loop[1] + shift, loop[1]});
  EXPECT_NO_THROW(repair(twice));
}

TEST(Repair, NoCoordinateIsNewAndNothingIsForgotten) {
  TriangleMesh mesh = test::together(crown(), test::dome(1, 1), Point(7, 0, 0));
  for (const std::size_t t : {30U, 31U}) std::swap(mesh.triangles[t][0], mesh.triangles[t][1]);
  mesh.vertices.emplace_back(1, 1, 1);  // unreferenced: no repair
  const RepairedMesh repaired = repair(mesh);
  std::vector<int> seen(mesh.vertices.size(), 0);
  for (std::size_t v = 0; v < repaired.mesh.vertices.size(); ++v) {
    EXPECT_EQ(repaired.mesh.vertices[v], mesh.vertices[static_cast<std::size_t>(repaired.old_vertices[v])]);
    ++seen[static_cast<std::size_t>(repaired.old_vertices[v])];
  }
  for (const RepairStep& s : repaired.steps)
    for (const int v : s.vertices) ++seen[static_cast<std::size_t>(v)];
  EXPECT_EQ(seen.back(), 0);
  seen.pop_back();
  EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), static_cast<std::ptrdiff_t>(seen.size()));
}

TEST(Repair, BadInput) {
  TriangleMesh mesh = crown();
  mesh.triangles.push_back({0, 1, 1000});
  EXPECT_THROW(repair(mesh), InputError);
  mesh = crown();
  mesh.vertices[3].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(repair(mesh), InputError);
  mesh = {{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}};
  EXPECT_THROW(repair(mesh), InputError) << "nothing left";
  EXPECT_THROW(repair({}), InputError);
}

TEST(Repair, EveryActionsTextIsReadBack) {
  std::set<std::string> texts;
  for (int a = 0; a <= static_cast<int>(RepairAction::cap_at_border_dropped); ++a) {
    RepairStep done;
    done.action = static_cast<RepairAction>(a);
    texts.insert(action_text(done));
    EXPECT_EQ(action_of_text(action_text(done)), done.action) << action_text(done);
  }
  EXPECT_EQ(texts.size(), 15U);
  EXPECT_EQ(action_of_text("of a later version"), RepairAction::other);
}

}  // namespace
}  // namespace rhizodont
