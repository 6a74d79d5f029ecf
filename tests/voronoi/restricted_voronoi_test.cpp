// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "voronoi/restricted_voronoi.hpp"

#include "mesh/diagnosis.hpp"
#include "mesh/geometry.hpp"
#include "mesh/sampling.hpp"
#include "mesh/test_meshes.hpp"
#include "rhizodont/error.hpp"
#include "voronoi/predicates.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <random>
#include <utility>

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
  RestrictedVoronoiOptions moments;
  moments.cell_moments = true;
  const RestrictedVoronoi with_moments = restricted_voronoi(sites, surface, moments);
  for (const std::size_t threads : {1U, 2U, 4U}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    EXPECT_EQ(restricted_voronoi(sites, surface).triangles, reference.triangles);
    const RestrictedVoronoi again = restricted_voronoi(sites, surface, moments);
    EXPECT_EQ(again.cell_mass, with_moments.cell_mass);
    EXPECT_EQ(again.cell_centroid, with_moments.cell_centroid);
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

/// The dual by exact predicates alone: every site cuts every facet of every other, in the order of their indices.
std::vector<Triangle> reference_dual(const std::vector<Point>& sites, const TriangleMesh& surface) {
  std::vector<Triangle> dual;
  const auto count = static_cast<int>(sites.size());
  const auto site = [&](int i) { return Site{&sites[static_cast<std::size_t>(i)], i}; };
  for (const Triangle& facet : surface.triangles) {
    std::array<const Point*, 3> q;
    for (std::size_t k = 0; k < 3; ++k) q[k] = &surface.vertices[static_cast<std::size_t>(facet[k])];
    for (int i = 0; i < count; ++i) {
      std::vector<int> lines{-1, -2, -3};  // facet edge k as -1 - k, bisector with j as j
      for (int j = 0; j < count && !lines.empty(); ++j) {
        if (j == i) continue;
        const std::size_t n = lines.size();
        std::vector<int> sides(n), kept;
        for (std::size_t k = 0; k < n; ++k) {
          const int a = lines[(k + n - 1) % n], b = lines[k];
          const auto edge = static_cast<std::size_t>(-1 - std::min(a, b));
          if (a < 0 && b < 0)
            sides[k] = side1(site(i), site(j), *q[static_cast<std::size_t>(-1 - b)]);
          else if (a >= 0 && b >= 0)
            sides[k] = side3(site(i), site(a), site(b), site(j), *q[0], *q[1], *q[2]);
          else
            sides[k] = side2(site(i), site(std::max(a, b)), site(j), *q[edge], *q[(edge + 1) % 3]);
        }
        for (std::size_t k = 0; k < n; ++k) {
          const int ahead = sides[(k + 1) % n];
          if (sides[k] > 0 || ahead > 0) kept.push_back(lines[k]);
          if (sides[k] > 0 && ahead < 0) kept.push_back(j);
        }
        lines = kept;
      }
      for (std::size_t k = 0; k < lines.size(); ++k) {
        const int a = lines[(k + lines.size() - 1) % lines.size()], b = lines[k];
        if (a > i && b > i) dual.push_back({i, a, b});
      }
    }
  }
  std::sort(dual.begin(), dual.end());
  return dual;
}

/// On a closed surface each arc between two cells ends in two corners, which see it in opposite directions.
bool every_edge_is_matched(const std::vector<Triangle>& dual) {
  std::map<std::pair<int, int>, int> balance;
  for (const Triangle& t : dual)
    for (std::size_t i = 0; i < 3; ++i) {
      const int a = t[i], b = t[(i + 1) % 3];
      balance[std::minmax(a, b)] += a < b ? 1 : -1;
    }
  return std::all_of(balance.begin(), balance.end(), [](const auto& edge) { return edge.second == 0; });
}

TriangleMesh scaled_cube(double size) {
  TriangleMesh cube = test::cube();
  for (Point& p : cube.vertices) p *= size;
  return cube;
}

std::vector<Point> lattice(int from, int to) {
  std::vector<Point> points;
  for (int x = from; x <= to; ++x)
    for (int y = from; y <= to; ++y)
      for (int z = from; z <= to; ++z) points.emplace_back(x, y, z);
  return points;
}

TEST(RestrictedVoronoi, AgreesWithExactPredicatesAlone) {
  const TriangleMesh ball = test::sphere(2);
  EXPECT_EQ(restricted_voronoi(sample_surface(ball, 40, 1).points, ball).triangles,
            reference_dual(sample_surface(ball, 40, 1).points, ball));
  // Degenerate: lattice sites with facets in planes of symmetry, through bisectors, through sites.
  for (const double size : {2.0, 1.5, 1.0}) {
    const std::vector<Point> sites = lattice(0, 2);
    const TriangleMesh cube = scaled_cube(size);
    EXPECT_EQ(restricted_voronoi(sites, cube).triangles, reference_dual(sites, cube)) << size;
  }
  // Sites in pairs, all vertices of the surface; and a surface with needles and facets without area.
  std::vector<Point> twice = test::sphere(1).vertices;
  for (const Point& p : test::sphere(1).vertices) twice.push_back(p);
  EXPECT_EQ(restricted_voronoi(twice, test::sphere(1)).triangles, reference_dual(twice, test::sphere(1)));
  TriangleMesh poor = test::grid(4);
  for (std::size_t v = 0; v < poor.vertices.size(); ++v) {
    Point& p = poor.vertices[v];
    p = v % 4 == 0 ? Point(2, 2, 0) : Point(p.x(), 1e-12 * p.y() + 2, std::floor(0.5 * p.x()));
  }
  const std::vector<Point> sites = lattice(1, 3);
  EXPECT_EQ(restricted_voronoi(sites, poor).triangles, reference_dual(sites, poor));
}

TEST(RestrictedVoronoi, FacetsAgreeOnLattices) {
  std::vector<TriangleMesh> surfaces{scaled_cube(4), scaled_cube(3.5), test::sphere(4, 2.5), test::sphere(3, 3)};
  for (TriangleMesh& surface : surfaces) {
    const auto dual = restricted_voronoi(lattice(-3, 5), surface).triangles;
    EXPECT_FALSE(dual.empty());
    EXPECT_TRUE(every_edge_is_matched(dual));
    // The same within a hair: nearly degenerate everywhere.
    for (Point& p : surface.vertices) p += Point(1e-15, -2e-15, 1e-15);
    EXPECT_TRUE(every_edge_is_matched(restricted_voronoi(lattice(-3, 5), surface).triangles));
  }
}

TEST(RestrictedVoronoi, LatticeSitesOnACubeAndASphereGiveSolids) {
  // All lattice points of a cube's surface: four cells meet at every inner corner, facets are cut along their
  // diagonals.
  std::vector<Point> on_cube;
  for (const Point& p : lattice(0, 4))
    if (p.minCoeff() == 0 || p.maxCoeff() == 4) on_cube.push_back(p);
  const RestrictedVoronoi cube = restricted_voronoi(on_cube, scaled_cube(4));
  EXPECT_EQ(cube.triangles.size(), 2 * on_cube.size() - 4);
  EXPECT_TRUE(diagnose(dual_mesh(on_cube, cube)).is_closed_solid());
  // The same points pushed out to a sphere: rings of cocircular sites, all of them cospherical.
  std::vector<Point> on_ball;
  for (const Point& p : on_cube) on_ball.push_back(3 * (p - Point(2, 2, 2)).normalized());
  const RestrictedVoronoi ball = restricted_voronoi(on_ball, test::sphere(4, 3));
  EXPECT_TRUE(diagnose(dual_mesh(on_ball, ball)).is_closed_solid());
  EXPECT_TRUE(every_edge_is_matched(ball.triangles));
}

TEST(RestrictedVoronoi, MomentsByADensity) {
  const TriangleMesh plane = test::grid(12);
  RestrictedVoronoiOptions options;
  options.cell_moments = true;
  for (const Point& p : plane.vertices) options.density.push_back(p.x());
  // One cell: integrals of x, x^2 and x y over the square of side 12.
  const RestrictedVoronoi whole = restricted_voronoi({Point(5, 5, 1)}, plane, options);
  EXPECT_NEAR(whole.cell_area[0], 144, 1e-9);
  EXPECT_NEAR(whole.cell_mass[0], 864, 1e-9);
  EXPECT_LT((whole.cell_centroid[0] - Point(8, 6, 0)).norm(), 1e-9);
  // Many cells: they add up to the same.
  const std::vector<Point> sites = sample_surface(plane, 50, 2).points;
  const RestrictedVoronoi parts = restricted_voronoi(sites, plane, options);
  double mass = 0;
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < sites.size(); ++i) {
    mass += parts.cell_mass[i];
    moment += parts.cell_mass[i] * parts.cell_centroid[i];
  }
  EXPECT_NEAR(mass, 864, 1e-9);
  EXPECT_LT((moment / mass - Point(8, 6, 0)).norm(), 1e-9);
  // An even density changes no centroid.
  options.density.clear();
  const RestrictedVoronoi even = restricted_voronoi(sites, plane, options);
  options.density.assign(plane.vertices.size(), 2.5);
  const RestrictedVoronoi dense = restricted_voronoi(sites, plane, options);
  for (std::size_t i = 0; i < sites.size(); ++i) {
    EXPECT_NEAR(dense.cell_mass[i], 2.5 * even.cell_area[i], 1e-9);
    EXPECT_LT((dense.cell_centroid[i] - even.cell_centroid[i]).norm(), 1e-9);
  }
  options.density.pop_back();
  EXPECT_THROW(restricted_voronoi(sites, plane, options), UsageError);
}

}  // namespace
}  // namespace rhizodont
