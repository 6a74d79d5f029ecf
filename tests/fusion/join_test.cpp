// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// On a ball about the origin the planes between sites of equal distance from it pass through the origin: the dual of
// their diagram on any surface that is seen once from there is their convex hull.

#include "fusion/join.hpp"

#include "fusion/tiny_patches.hpp"
#include "rhizodont/error.hpp"

#include <cmath>

namespace rhizodont {
namespace {

using test::as_set;
using test::pyramid;

const TriangleMesh& ball() {
  static const TriangleMesh mesh = test::sphere(4);
  return mesh;
}

/// Faces of the convex hull of points in general position, by trying all.
std::vector<Triangle> hull(const std::vector<Point>& points) {
  std::vector<Triangle> faces;
  const auto n = static_cast<std::int32_t>(points.size());
  const auto at = [&](std::int32_t i) { return points[static_cast<std::size_t>(i)]; };
  for (std::int32_t a = 0; a < n; ++a)
    for (std::int32_t b = a + 1; b < n; ++b)
      for (std::int32_t c = a + 1; c < n; ++c) {
        if (c == b) continue;
        const Eigen::Vector3d normal = (at(b) - at(a)).cross(at(c) - at(a));
        bool outside = false;
        for (std::int32_t p = 0; p < n && !outside; ++p)
          outside = p != a && p != b && p != c && normal.dot(at(p) - at(a)) > 0;
        if (!outside) faces.push_back({a, b, c});
      }
  return as_set(faces);
}

/// Points of the unit ball's lower part at random.
std::vector<Point> random_root(int count, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::vector<Point> points;
  while (static_cast<int>(points.size()) < count) {
    const Point p = Point(normal(random), normal(random), normal(random)).normalized();
    if (p.z() < -0.15) points.push_back(p);
  }
  return points;
}

TEST(Join, ThePyramidOverOneVertexIsTheOctahedron) {
  const Joining joining = join_crown_and_root(pyramid(), {{0, 0, -1}}, ball());
  EXPECT_EQ(joining.crown_vertices, 5);
  EXPECT_EQ(joining.steiner_points, 0);
  EXPECT_EQ(joining.non_delaunay_edges_left, 0);
  EXPECT_EQ(joining.sites.size(), 6U);
  EXPECT_EQ(joining.triangles, hull(joining.sites));
  EXPECT_EQ(joining.triangles.size(), 8U);
  EXPECT_EQ(joining.crown_triangles_direct, 4);
  EXPECT_EQ(joining.crown_in_dual, (std::vector<bool>(4, true)));
  EXPECT_EQ(joining.sites_without_cell, 0);
}

TEST(Join, TheDualOnABallIsTheConvexHull) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(seed);
    const Joining joining = join_crown_and_root(pyramid(), random_root(2 + static_cast<int>(seed), seed), ball());
    EXPECT_EQ(joining.triangles, hull(joining.sites));
    EXPECT_EQ(joining.triangles.size(), 2 * joining.sites.size() - 4) << "Euler";
    int direct = 0;
    for (const Triangle& t : pyramid().triangles)
      direct += static_cast<int>(std::count(joining.triangles.begin(), joining.triangles.end(), as_set({t}).front()));
    EXPECT_EQ(joining.crown_triangles_direct, direct);
  }
}

TEST(Join, ATurnOrAMirrorChangesNothing) {
  const std::vector<Point> root = random_root(9, 50);
  const Joining joining = join_crown_and_root(pyramid(), root, ball());
  const test::Motion motion;
  std::vector<Point> moved, in_mirror;
  for (const Point& p : root) {
    moved.push_back(motion(p));
    in_mirror.emplace_back(-p.x(), p.y(), p.z());
  }
  EXPECT_EQ(join_crown_and_root(motion(pyramid()), moved, motion(ball())).triangles, joining.triangles);
  EXPECT_EQ(as_set(join_crown_and_root(test::mirrored(pyramid()), in_mirror, test::mirrored(ball())).triangles),
            as_set(test::mirrored(joining.triangles)));
}

TEST(Join, RootVerticesInAnotherOrderGiveTheSame) {
  const std::vector<Point> root = random_root(9, 51);
  const std::vector<int> order = test::random_order(root.size(), 2);
  std::vector<Point> other(root.size());
  for (std::size_t i = 0; i < root.size(); ++i) other[static_cast<std::size_t>(order[i])] = root[i];
  std::vector<Triangle> triangles = join_crown_and_root(pyramid(), root, ball()).triangles;
  for (Triangle& t : triangles)
    for (std::int32_t& v : t)
      if (v >= 5) v = 5 + order[static_cast<std::size_t>(v) - 5];
  EXPECT_EQ(join_crown_and_root(pyramid(), other, ball()).triangles, as_set(triangles));
}

TEST(Join, ACrowdedVertexGetsNoCell) {
  const std::vector<Point> root = random_root(6, 52);
  std::vector<Triangle> expected = join_crown_and_root(pyramid(), root, ball()).triangles;
  std::vector<Point> crowded = root;
  // Mean edge length is 1.41, least distance 0.0028: one beside root vertex 2, one beside the crown's vertex 0.
  crowded.insert(crowded.begin() + 3, (root[2] + Point(0, 1e-4, 0)).normalized());
  crowded.push_back(Point(1, 0, -1e-3).normalized());
  for (Triangle& t : expected)
    for (std::int32_t& v : t) v += static_cast<std::int32_t>(v >= 8);
  const Joining joining = join_crown_and_root(pyramid(), crowded, ball());
  EXPECT_EQ(joining.triangles, expected);
  EXPECT_EQ(joining.sites_without_cell, 2);
  std::vector<bool> in_diagram(13, true);
  in_diagram[8] = in_diagram[12] = false;
  EXPECT_EQ(joining.in_diagram, in_diagram);
  JoinOptions all;
  all.least_distance = 0;
  EXPECT_EQ(join_crown_and_root(pyramid(), crowded, ball(), all).sites_without_cell, 0);
}

TEST(Join, AVertexThatTheSurfaceDoesNotComeNearIsCounted) {
  // The origin is 1 away from the ball, on which no place is as far as that from the nearest of the octahedron's
  // corners.
  const Joining joining = join_crown_and_root(pyramid(), {{0, 0, -1}, {0, 0, 0}}, ball());
  EXPECT_EQ(joining.sites_without_cell, 1);
  EXPECT_TRUE(joining.in_diagram[6]) << "not crowded out";
  EXPECT_EQ(joining.triangles, join_crown_and_root(pyramid(), {{0, 0, -1}}, ball()).triangles);
}

TEST(Join, SteinerPointsLieOnInnerEdgesBetweenCrownAndRoot) {
  // Two triangles over the edge 0-2, which sees 110 degrees from either side.
  const double h = 0.7;
  const TriangleMesh flat{{{1, 0, 0}, {0, h, 0}, {-1, 0, 0}, {0, -h, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  const Point root(0, 0, -1);
  const Joining joining = join_crown_and_root(flat, {root}, ball());
  ASSERT_GE(joining.steiner_points, 1);
  EXPECT_EQ(joining.crown_vertices, 4);
  EXPECT_EQ(joining.sites.size(), 4U + static_cast<std::size_t>(joining.steiner_points) + 1);
  for (std::size_t v = 0; v < 4; ++v) EXPECT_EQ(joining.sites[v], flat.vertices[v]);
  for (std::size_t v = 4; v + 1 < joining.sites.size(); ++v) {
    EXPECT_EQ(joining.sites[v].y(), 0);
    EXPECT_EQ(joining.sites[v].z(), 0);
    EXPECT_LT(std::abs(joining.sites[v].x()), 1);
  }
  EXPECT_EQ(joining.sites.back(), root);
  EXPECT_EQ(joining.non_delaunay_edges_left, 0);
  JoinOptions none;
  none.delaunay.steiner_limit = 0;
  EXPECT_EQ(join_crown_and_root(flat, {root}, ball(), none).non_delaunay_edges_left, 1);
}

TEST(Join, BadInputIsRefused) {
  JoinOptions options;
  options.least_distance = -1e-3;
  EXPECT_THROW(join_crown_and_root(pyramid(), {{0, 0, -1}}, ball(), options), UsageError);
  EXPECT_THROW(join_crown_and_root(pyramid(), {{0, 0, -1}}, TriangleMesh{}), InputError) << "no surface";
  TriangleMesh fin = pyramid();
  fin.vertices.emplace_back(2, 2, 2);
  fin.triangles.push_back({0, 4, 5});
  EXPECT_THROW(join_crown_and_root(fin, {{0, 0, -1}}, ball()), InputError) << "three triangles at an edge";
  EXPECT_THROW(join_crown_and_root(pyramid(), {{0, 0, std::nan("")}}, ball()), InputError);
}

}  // namespace
}  // namespace rhizodont
