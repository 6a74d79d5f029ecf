// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "fusion/fuse.hpp"
#include "fusion/root_sites.hpp"
#include "fusion/surface_walk.hpp"
#include "mesh/adjacency.hpp"
#include "mesh/closest_point.hpp"
#include "mesh/geometry.hpp"
#include "mesh/nearest_vertex.hpp"
#include "mesh/test_meshes.hpp"
#include "rhizodont/check.hpp"
#include "teeth/prepared_crown.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace rhizodont {
namespace {

TriangleMesh cap(int level, double radius, double height) {
  const TriangleMesh sphere = test::sphere(level, radius);
  std::vector<bool> mask;
  for (const Triangle& t : sphere.triangles)
    mask.push_back(std::all_of(t.begin(), t.end(),
                               [&](int v) { return sphere.vertices[static_cast<std::size_t>(v)].z() > height; }));
  return submesh(sphere, mask).mesh;
}

TEST(SurfaceWalk, FindsTheClosestPointOfAConvexSurfaceFromAnywhere) {
  const TriangleMesh sphere = test::sphere(3, 5);
  const SurfaceWalk walk(sphere);
  const ClosestPointIndex index(sphere);
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 300; ++i) {
    const Eigen::Vector3d direction = Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized();
    const Point p = (5 + 0.2 * std::abs(normal(random))) * direction;
    const SurfacePlace place = walk.closest(p, static_cast<int>(random() % sphere.triangles.size()));
    EXPECT_NEAR((place.point - p).norm(), index.closest(p).distance, 1e-9);
  }
}

struct SitesOnSphere {
  PreparedCrown prepared = prepare_crown(cap(4, 5, 0.5));
  const TriangleMesh& crown = prepared.mesh;
  TriangleMesh surface = test::sphere(5, 5);
  const CrownBorder& border = prepared.border;
  EdgeLengths lengths{crown, border, 0.3, 1.2, 0.15};
  SurfaceWalk walk{surface};
  std::vector<bool> is_root =
      separate_crown_and_root(surface, crown_distances(surface, prepared), Eigen::Vector3d::UnitZ());
  std::vector<Point> sites = root_sites(walk, is_root, crown, border, lengths);
};

TEST(RootSites, KeepTheirDistanceAndLeaveNoGap) {
  const SitesOnSphere s;
  const NearestVertexIndex index(s.sites);
  for (const Point& p : s.sites) {
    const auto near = index.nearest(p, 2);
    EXPECT_GE(std::sqrt(near[1].squared_distance), 0.6 * s.lengths.at(p));
    for (const Point& c : s.crown.vertices) ASSERT_GE((p - c).norm(), 0.6 * s.lengths.at(p));
  }
  for (std::size_t v = 0; v < s.surface.vertices.size(); ++v) {
    if (!s.is_root[v]) continue;
    const Point& p = s.surface.vertices[v];
    double nearest = std::sqrt(index.nearest(p).squared_distance);
    for (const Point& c : s.crown.vertices) nearest = std::min(nearest, (p - c).norm());
    EXPECT_LE(nearest, 1.1 * s.lengths.at(p));
  }
}

TEST(RootSites, AreAsManyAsAnEquilateralLatticeHas) {
  // Far from the border the length is 0.3 mm: one site per area of two equilateral triangles of that side.
  const SitesOnSphere s;
  const auto count = std::count_if(s.sites.begin(), s.sites.end(), [](const Point& p) { return p.z() < -2; });
  const double area = 2 * M_PI * 5 * 3;
  EXPECT_NEAR(static_cast<double>(count), area / (std::sqrt(3.0) / 2 * 0.09), 0.1 * area / (std::sqrt(3.0) / 2 * 0.09));
}

TEST(EdgeLengths, FollowTheBorderAndFade) {
  const SitesOnSphere s;
  const auto [a, b] = s.border.half_edges.front();
  const Point &pa = s.crown.vertices[static_cast<std::size_t>(a)], &pb = s.crown.vertices[static_cast<std::size_t>(b)];
  EXPECT_NEAR(s.lengths.at(0.5 * (pa + pb)), (pa - pb).norm(), 0.1 * (pa - pb).norm());
  EXPECT_EQ(s.lengths.at({0, 0, -5}), 0.3);
}

TEST(EdgeLengths, AreThoseOfAllBorderEdges) {
  // Two loops, edges of very different lengths: a cap with a hole, pulled along x.
  TriangleMesh crown = cap(4, 5, 0.5);
  crown.triangles.erase(crown.triangles.begin() + static_cast<std::ptrdiff_t>(crown.triangles.size() / 2));
  for (Point& p : crown.vertices) p.x() *= 1 + 0.4 * p.x();
  const CrownBorder border = find_crown_border(crown);
  constexpr double root = 0.3, growth = 0.9, shrinkage = 0.15;
  const EdgeLengths lengths(crown, border, root, growth, shrinkage);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> anywhere(-8, 8);
  int other_than_root = 0;
  for (int i = 0; i < 2000; ++i) {
    const Point p(anywhere(random), anywhere(random), anywhere(random));
    double longest = std::numeric_limits<double>::max(), wanted = root;
    for (const auto& [from, to] : border.half_edges) {
      const Point &a = crown.vertices[static_cast<std::size_t>(from)],
                  &b = crown.vertices[static_cast<std::size_t>(to)];
      const double distance = (p - 0.5 * (a + b)).norm(), length = (a - b).norm();
      longest = std::min(longest, length + growth * distance);
      wanted = std::max(wanted, length - shrinkage * distance);
    }
    EXPECT_EQ(lengths.at(p), std::min(longest, wanted)) << p.transpose();
    if (lengths.at(p) != root) ++other_than_root;
  }
  EXPECT_GT(other_than_root, 100);
}

TEST(CrownBorder, NotchOpenToTheRoot) {
  // A square of four squares without one: the border turns by a right angle that opens outward.
  TriangleMesh mesh;
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 3; ++x) mesh.vertices.emplace_back(x, y, 0);
  for (const int corner : {0, 1, 3}) {
    mesh.triangles.push_back({corner, corner + 1, corner + 4});
    mesh.triangles.push_back({corner, corner + 4, corner + 3});
  }
  EXPECT_NEAR(find_crown_border(compact(mesh).mesh).sharpest_notch, 90, 1e-9);
}

TEST(Root, TrianglesKeepPromiseThree) {
  const TriangleMesh crown = cap(4, 5, 0.5);
  const FusedTooth fused = fuse_crown_and_root(prepare_crown(crown), test::sphere(5, 5), Eigen::Vector3d::UnitZ());
  const CheckReport report = check(crown, fused.tooth.mesh);
  EXPECT_TRUE(report.holds());
  EXPECT_TRUE(report.new_triangles.holds());
  EXPECT_GT(report.new_triangles.inner->theta_min, 25);
  EXPECT_TRUE(fused.warnings.empty());
  const ClosestPointIndex index(test::sphere(5, 5));
  for (const Point& p : fused.tooth.mesh.vertices) ASSERT_LT(index.closest(p).distance, 0.03);
}

TEST(Root, MendingEndsWithItsBudget) {
  TriangleMesh crown = cap(4, 5, 0.5);
  const auto edge = find_crown_border(crown).half_edges.front();
  Point& p = crown.vertices[static_cast<std::size_t>(edge.first)];
  p += 0.995 * (crown.vertices[static_cast<std::size_t>(edge.second)] - p);
  FuseOptions options;
  options.other_growths.clear();
  const auto mended = [&] {
    return fuse_crown_and_root(prepare_crown(crown), test::sphere(5, 5), Eigen::Vector3d::UnitZ(), options)
        .remeshing.mended;
  };
  EXPECT_GT(mended(), 0);
  options.remesh.mending_places = 0;
  EXPECT_EQ(mended(), 0);
}

TEST(Root, ShortBorderEdgesDoNotSpoilIt) {
  // Neighbouring border vertices moved together until the edges between them are a small share of their length.
  for (const double share : {0.02, 0.003, 0.0005}) {
    SCOPED_TRACE(share);
    TriangleMesh crown = cap(4, 5, 0.5);
    const auto edges = find_crown_border(crown).half_edges;
    for (const std::size_t e : {std::size_t{0}, edges.size() / 2}) {
      Point& p = crown.vertices[static_cast<std::size_t>(edges[e].first)];
      p += (1 - share) * (crown.vertices[static_cast<std::size_t>(edges[e].second)] - p);
    }
    const FusedTooth fused = fuse_crown_and_root(prepare_crown(crown), test::sphere(5, 5), Eigen::Vector3d::UnitZ());
    const CheckReport report = check(crown, fused.tooth.mesh);
    EXPECT_TRUE(report.holds());
    EXPECT_GT(report.new_triangles.at_border->theta_min, 5);
    EXPECT_GT(report.new_triangles.inner->theta_min, 20);
  }
}

}  // namespace
}  // namespace rhizodont
