// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "guiding/crown_fit.hpp"

#include "mesh/closest_point.hpp"
#include "mesh/diagnosis.hpp"
#include "mesh/geometry.hpp"
#include "mesh/self_intersection.hpp"
#include "mesh/test_meshes.hpp"
#include "rhizodont/error.hpp"
#include "teeth/prepared_crown.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace rhizodont {
namespace {

constexpr double radius = 5;

double farthest(const TriangleMesh& surface, const TriangleMesh& crown) {
  const ClosestPointIndex index(surface);
  double most = 0;
  for (const Point& p : crown.vertices) most = std::max(most, index.closest(p).distance);
  return most;
}

/// Upper half of a ball with a ring-shaped fissure.
TriangleMesh furrowed_crown() {
  TriangleMesh crown = test::dome(5, radius);
  for (Point& p : crown.vertices) {
    const double r = std::hypot(p.x(), p.y());
    if (p.z() > 0) p *= 1 - 0.04 * std::exp(-std::pow((r - 2.5) / 0.4, 2));
  }
  return crown;
}

TEST(CrownFit, BringsACoarseBallWithinTheToleranceOfTheCrown) {
  const TriangleMesh crown = furrowed_crown();
  TriangleMesh surface = test::sphere(4, 1.01 * radius);
  ASSERT_GT(farthest(surface, crown), 0.1);
  const TriangleMesh before = surface;
  CrownFitOptions options;
  options.tolerance = 0.02;
  const CrownFit fit = fit_to_crown(surface, prepare_crown(crown), options);
  EXPECT_FALSE(fit.undone);
  EXPECT_GT(fit.moved_vertices, 0);
  EXPECT_EQ(static_cast<std::size_t>(fit.added_vertices), surface.vertices.size() - before.vertices.size());
  const Diagnosis diagnosis = diagnose(surface);
  EXPECT_TRUE(diagnosis.is_closed_solid());
  EXPECT_EQ(static_cast<int>(surface.vertices.size()) - static_cast<int>(surface.triangles.size()) / 2, 2);
  EXPECT_TRUE(self_intersecting_triangles(surface).empty());
  EXPECT_LT(farthest(surface, crown), 0.03);
  // Away from the crown nothing happens.
  for (std::size_t v = 0; v < before.vertices.size(); ++v)
    if (before.vertices[v].z() < -2) {
      EXPECT_EQ(before.vertices[v], surface.vertices[v]);
    }
}

TEST(CrownFit, LeavesASurfaceThatFitsAlone) {
  TriangleMesh surface = test::sphere(5, radius);
  const TriangleMesh before = surface;
  const CrownFit fit = fit_to_crown(surface, prepare_crown(test::dome(5, radius)));
  EXPECT_EQ(fit.added_vertices, 0);
  for (std::size_t v = 0; v < before.vertices.size(); ++v)
    EXPECT_LT((surface.vertices[v] - before.vertices[v]).norm(), 0.02);
}

TEST(CrownFit, DoesNotReachForACrownThatIsFarAway) {
  TriangleMesh surface = test::sphere(3, 0.5 * radius);
  const TriangleMesh before = surface;
  CrownFitOptions options;
  options.most_rounds = 2;
  fit_to_crown(surface, prepare_crown(test::dome(4, radius)), options);
  for (std::size_t v = 0; v < before.vertices.size(); ++v) EXPECT_EQ(before.vertices[v], surface.vertices[v]);
}

TEST(CrownFit, TurnsAroundAPoleOfHundredsOfTriangles) {
  // A ball by latitude and longitude: its poles have 150 triangles each.
  constexpr int around = 150, rings = 60;
  TriangleMesh surface;
  for (int r = 1; r < rings; ++r)
    for (int i = 0; i < around; ++i) {
      const double polar = std::numbers::pi * r / rings, turn = 2 * std::numbers::pi * i / around;
      surface.vertices.emplace_back(1.01 * radius * std::sin(polar) * std::cos(turn),
                                    1.01 * radius * std::sin(polar) * std::sin(turn), 1.01 * radius * std::cos(polar));
    }
  const int top = static_cast<int>(surface.vertices.size()), bottom = top + 1, last = (rings - 2) * around;
  surface.vertices.emplace_back(0, 0, 1.01 * radius);
  surface.vertices.emplace_back(0, 0, -1.01 * radius);
  for (int i = 0; i < around; ++i) {
    const int j = (i + 1) % around;
    surface.triangles.push_back({top, i, j});
    surface.triangles.push_back({bottom, last + j, last + i});
    for (int r = 0; r + 2 < rings; ++r) {
      const int a = r * around + i, b = r * around + j;
      surface.triangles.push_back({a, a + around, b});
      surface.triangles.push_back({b, a + around, b + around});
    }
  }
  ASSERT_TRUE(diagnose(surface).is_closed_solid());
  TriangleMesh crown = furrowed_crown();
  for (Point& p : crown.vertices) p.z() -= 0.1 * std::exp(-p.head<2>().squaredNorm());  // a dent at the pole
  CrownFitOptions options;
  options.tolerance = 0.01;
  const CrownFit fit = fit_to_crown(surface, prepare_crown(crown), options);
  EXPECT_FALSE(fit.undone);
  EXPECT_TRUE(diagnose(surface).is_closed_solid());
  EXPECT_LT(farthest(surface, crown), 0.03);
}

TEST(CrownFit, IsUndoneWhereTheSurfaceWouldMeetItself) {
  // A plate that faces up, under the ball: drawn onto it, the ball's upper half would go through the lower one.
  TriangleMesh plate = test::grid(6);
  for (Point& p : plate.vertices) p -= Point(3.1, 2.9, 2);
  CrownFitOptions options;
  options.reach = 10;
  for (const int fading_rings : {0, 3}) {
    options.fading_rings = fading_rings;
    TriangleMesh surface = test::sphere(3, 1);
    const TriangleMesh before = surface;
    const CrownFit fit = fit_to_crown(surface, prepare_crown(plate), options);
    EXPECT_TRUE(fit.undone);
    EXPECT_EQ(fit.moved_vertices, 0);
    EXPECT_EQ(fit.added_vertices, 0);
    EXPECT_EQ(surface.vertices, before.vertices);
    EXPECT_EQ(surface.triangles, before.triangles);
  }
}

TEST(CrownFit, NeedsABorder) {
  TriangleMesh surface = test::sphere(2, radius);
  EXPECT_THROW(fit_to_crown(surface, prepare_crown(test::sphere(3, radius))), InputError);
}

}  // namespace
}  // namespace rhizodont
