// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "voronoi/restricted_voronoi.hpp"

#include "mesh/diagnosis.hpp"
#include "mesh/geometry.hpp"
#include "mesh/sampling.hpp"
#include "mesh/test_meshes.hpp"
#include "rhizodont/error.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <random>

namespace rhizodont {
namespace {

TriangleMesh dual_mesh(const std::vector<Point>& sites, const RestrictedVoronoi& voronoi) {
  return {sites, voronoi.triangles};
}

TEST(RestrictedVoronoi, DualOfASphereIsAClosedOutwardSphere) {
  const TriangleMesh surface = test::sphere(5);
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  std::vector<Point> sites;
  for (int i = 0; i < 300; ++i) sites.push_back(Point(normal(random), normal(random), normal(random)).normalized());
  const RestrictedVoronoi voronoi = restricted_voronoi(sites, surface);
  const Diagnosis d = diagnose(dual_mesh(sites, voronoi));
  EXPECT_TRUE(d.is_closed_solid());
  EXPECT_EQ(voronoi.triangles.size(), 2 * sites.size() - 4);
  EXPECT_TRUE(std::is_sorted(voronoi.triangles.begin(), voronoi.triangles.end()));
}

TEST(RestrictedVoronoi, CosphericalAndGridSitesGiveManifoldDuals) {
  // All sites on one sphere, and sites at the vertices of the surface itself.
  const TriangleMesh ball = test::sphere(3);
  EXPECT_TRUE(diagnose(dual_mesh(ball.vertices, restricted_voronoi(ball.vertices, ball))).is_closed_solid());
  // Four cells meet in every inner corner of a square lattice; ties must be broken alike in all facets.
  const TriangleMesh plane = test::grid(12);
  std::vector<Point> sites;
  for (int j = 0; j < 6; ++j)
    for (int i = 0; i < 6; ++i) sites.emplace_back(2 * i + 1, 2 * j + 1, 0);
  const RestrictedVoronoi voronoi = restricted_voronoi(sites, plane);
  EXPECT_EQ(voronoi.triangles.size(), 50U);
  const Diagnosis d = diagnose(dual_mesh(sites, voronoi));
  EXPECT_TRUE(d.is_oriented_manifold());
  EXPECT_EQ(d.euler_number, 1);
  for (std::size_t t = 0; t < voronoi.triangles.size(); ++t)
    EXPECT_GT(triangle_normal(dual_mesh(sites, voronoi), t).z(), 0.99) << "oriented like the surface";
}

TEST(RestrictedVoronoi, CellAreasAgreeWithNearestSitesOfSamples) {
  const TriangleMesh surface = test::torus(40, 24);
  const SurfaceSamples chosen = sample_surface(surface, 40, 5);
  RestrictedVoronoiOptions options;
  options.cell_moments = true;
  options.neighbours = 2;  // far too few: the lists have to grow
  const RestrictedVoronoi voronoi = restricted_voronoi(chosen.points, surface, options);
  const double total = surface_area(surface);
  EXPECT_NEAR(std::accumulate(voronoi.cell_area.begin(), voronoi.cell_area.end(), 0.0), total, 1e-9 * total);

  const SurfaceSamples samples = sample_surface(surface, 60000, 6);
  std::vector<int> count(chosen.points.size(), 0);
  for (const Point& p : samples.points) {
    std::size_t best = 0;
    for (std::size_t i = 1; i < chosen.points.size(); ++i)
      if ((p - chosen.points[i]).squaredNorm() < (p - chosen.points[best]).squaredNorm()) best = i;
    ++count[best];
  }
  for (std::size_t i = 0; i < count.size(); ++i) {
    const double share = voronoi.cell_area[i] / total;
    const double deviation = std::sqrt(share * (1 - share) / 60000);
    EXPECT_NEAR(count[i] / 60000.0, share, 5 * deviation) << i;
  }
}

TEST(RestrictedVoronoi, SitesWithoutSurfaceAndCoincidingSites) {
  const TriangleMesh plane = test::grid(4);
  // The third site is far above the plane, behind the others; the fourth coincides with the first.
  const std::vector<Point> sites{{1, 2, 0}, {3, 2, 0}, {2, 2, 50}, {1, 2, 0}};
  const RestrictedVoronoi voronoi = restricted_voronoi(sites, plane);
  EXPECT_EQ(voronoi.site_has_cell, (std::vector<bool>{true, true, false, false}));
  EXPECT_TRUE(voronoi.triangles.empty());
}

TEST(RestrictedVoronoi, SameForAnyNumberOfThreadsAndMotion) {
  const TriangleMesh surface = test::sphere(6, 7);
  const std::vector<Point> sites = sample_surface(surface, 800, 9).points;
  const RestrictedVoronoi reference = restricted_voronoi(sites, surface);
  for (const std::size_t threads : {1U, 2U, 4U}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    EXPECT_EQ(restricted_voronoi(sites, surface).triangles, reference.triangles);
  }
  // An exact motion: axes permuted cyclically. Cells are the same, so is their dual.
  const auto permute = [](std::vector<Point> points) {
    for (Point& p : points) p = Point(p.y(), p.z(), p.x());
    return points;
  };
  EXPECT_EQ(restricted_voronoi(permute(sites), {permute(surface.vertices), surface.triangles}).triangles,
            reference.triangles);
}

TEST(RestrictedVoronoi, BadInput) {
  const TriangleMesh ball = test::sphere(1);
  EXPECT_THROW(restricted_voronoi({}, ball), InputError);
  EXPECT_THROW(restricted_voronoi(ball.vertices, {}), InputError);
  EXPECT_THROW(restricted_voronoi({Point(0, 0, std::numeric_limits<double>::quiet_NaN())}, ball), InputError);
}

}  // namespace
}  // namespace rhizodont
