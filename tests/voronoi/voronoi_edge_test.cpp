// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "voronoi/voronoi_edge.hpp"

#include "mesh/sampling.hpp"
#include "mesh/test_meshes.hpp"
#include "rhizodont/error.hpp"
#include "voronoi/restricted_voronoi.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace rhizodont {
namespace {

TEST(VoronoiEdge, OfATriangleBetweenTwoSites) {
  // Circumcentre (1, 1, 0), radius sqrt(2); the sites above and below are 3 and 2 from it.
  const std::vector<Point> sites{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {1, 1, 3}, {1, 1, -2}};
  const VoronoiEdge edge = voronoi_edge(sites, {0, 1, 2});
  EXPECT_TRUE(edge.centre.isApprox(Point(1, 1, 0)));
  EXPECT_TRUE(edge.direction.isApprox(Eigen::Vector3d::UnitZ()));
  // (3 - t)^2 = 2 + t^2 and (t + 2)^2 = 2 + t^2
  EXPECT_NEAR(edge.high, 7.0 / 6, 1e-12);
  EXPECT_NEAR(edge.low, -0.5, 1e-12);
  EXPECT_EQ(edge.high_site, 3);
  EXPECT_EQ(edge.low_site, 4);
  EXPECT_FALSE(edge.is_empty());
  EXPECT_TRUE(std::isinf(voronoi_edge({sites.begin(), sites.begin() + 3}, {0, 1, 2}).high));
}

TEST(VoronoiEdge, IsEmptyWhereASiteIsNearerEverywhere) {
  EXPECT_TRUE(voronoi_edge({{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {1.5, 1.5, 0}}, {0, 1, 2}).is_empty());
  EXPECT_FALSE(voronoi_edge({{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {2.5, 2.5, 0}}, {0, 1, 2}).is_empty());
}

TEST(VoronoiEdge, FindsCrossingsByDirection) {
  const VoronoiEdge edge = voronoi_edge({{0.1, 0, 0}, {0, 0.1, 0}, {-0.1, -0.05, 0}}, {0, 1, 2});
  const auto up = outward_crossings(test::sphere(3, 2), edge);
  ASSERT_EQ(up.size(), 1U) << "the way out alone";
  EXPECT_NEAR(up[0], 2, 0.05);
  VoronoiEdge down = edge;
  down.direction = -edge.direction;
  EXPECT_EQ(outward_crossings(test::sphere(3, 2), down).size(), 1U);
}

TEST(VoronoiEdge, RefusesATriangleWithoutArea) {
  EXPECT_THROW(voronoi_edge({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {0, 1, 2}), InputError);
}

/// The oracle of the dual: a triangle is found if and only if the surface crosses its Voronoi edge.
void expect_dual_agrees(const std::vector<Point>& sites, const TriangleMesh& surface) {
  const std::vector<Triangle> dual = restricted_voronoi(sites, surface).triangles;
  // Triangles of the dual, and others that might have been: with a corner replaced by that of a neighbour.
  std::set<Triangle> candidates(dual.begin(), dual.end());
  for (std::size_t i = 0; i < dual.size(); ++i)
    for (std::size_t j = i + 1; j < std::min(dual.size(), i + 4); ++j) {
      Triangle t = dual[i];
      t[i % 3] = dual[j][j % 3];
      if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) candidates.insert(lowest_first(t));
    }
  int found = 0, not_found = 0;
  for (const Triangle& t : candidates) {
    const VoronoiEdge edge = voronoi_edge(sites, t);
    const auto crossings = outward_crossings(surface, edge);
    const bool crossed =
        std::any_of(crossings.begin(), crossings.end(), [&](double at) { return edge.low <= at && at <= edge.high; });
    const bool in_dual = std::binary_search(dual.begin(), dual.end(), t);
    EXPECT_EQ(in_dual, crossed) << t[0] << " " << t[1] << " " << t[2];
    ++(in_dual ? found : not_found);
  }
  EXPECT_GT(found, 50);
  EXPECT_GT(not_found, 50);
}

TEST(VoronoiEdge, AgreesWithTheDualOnClosedAndOpenSurfaces) {
  const TriangleMesh ball = test::sphere(4, 3);
  expect_dual_agrees(sample_surface(ball, 150, 4).points, ball);
  const TriangleMesh ring = test::torus(36, 20);
  expect_dual_agrees(sample_surface(ring, 200, 5).points, ring);
  // Sites beside the surface, as those of a crown are.
  TriangleMesh bumps = test::grid(16);
  for (Point& p : bumps.vertices) p.z() = std::sin(p.x()) + std::cos(1.3 * p.y());
  std::vector<Point> sites = sample_surface(bumps, 200, 6).points;
  for (std::size_t i = 0; i < sites.size(); ++i) sites[i].z() += 0.1 * std::sin(static_cast<double>(i));
  expect_dual_agrees(sites, bumps);
}

}  // namespace
}  // namespace rhizodont
