// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "voronoi/delaunay_mesh.hpp"

#include "mesh/closest_point.hpp"
#include "mesh/diagnosis.hpp"
#include "mesh/geometry.hpp"
#include "mesh/test_meshes.hpp"
#include "rhizodont/error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string>

namespace rhizodont {
namespace {

/// A bumpy surface of long triangles.
TriangleMesh stretched_bumps(int n) {
  TriangleMesh mesh = test::grid(n);
  for (Point& p : mesh.vertices) p = Point(4 * p.x(), p.y(), std::sin(2 * p.x()) + std::cos(p.y()));
  return mesh;
}

TEST(DelaunayMesh, TwoFlatTrianglesWithAnObtusePair) {
  // The edge from 0 to 1 is seen under two angles of about 127 degrees.
  const TriangleMesh kite{{{0, 0, 0}, {4, 0, 0}, {2, 1, 0}, {2, -1, 0}}, {{0, 1, 2}, {1, 0, 3}}};
  EXPECT_EQ(non_delaunay_edges(kite), (std::vector<std::array<int, 2>>{{0, 1}}));
  const DelaunayMesh result = make_delaunay_mesh(kite);
  EXPECT_TRUE(non_delaunay_edges(result.mesh).empty());
  ASSERT_EQ(result.steiner_edges.size(), 1U);
  EXPECT_EQ(result.steiner_edges[0], (std::array<int, 2>{0, 1}));
  EXPECT_EQ(result.mesh.vertices[4], Point(2, 0, 0));
  EXPECT_EQ(result.mesh.triangles.size(), 4U);
}

TEST(DelaunayMesh, KeepsTheSurfaceAndEndsDelaunay) {
  const TriangleMesh mesh = stretched_bumps(12);
  ASSERT_FALSE(non_delaunay_edges(mesh).empty());
  const DelaunayMesh result = make_delaunay_mesh(mesh);
  EXPECT_EQ(result.edges_left, 0);
  EXPECT_TRUE(non_delaunay_edges(result.mesh).empty());
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) EXPECT_EQ(result.mesh.vertices[v], mesh.vertices[v]);
  // Each input triangle is covered exactly by its pieces, which face the same way.
  std::map<int, double> area;
  for (std::size_t t = 0; t < result.mesh.triangles.size(); ++t) {
    const int parent = result.parent_triangle[t];
    area[parent] += triangle_area(result.mesh, t);
    EXPECT_GT(triangle_normal(result.mesh, t).dot(triangle_normal(mesh, static_cast<std::size_t>(parent))), 1 - 1e-9);
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    EXPECT_NEAR(area[static_cast<int>(t)], triangle_area(mesh, t), 1e-9);
  // Steiner points lie on their edges; the border has none.
  const Diagnosis d = diagnose(mesh);
  for (std::size_t i = 0; i < result.steiner_edges.size(); ++i) {
    const auto [a, b] = result.steiner_edges[i];
    const Point& p = result.mesh.vertices[mesh.vertices.size() + i];
    const Point &pa = mesh.vertices[static_cast<std::size_t>(a)], &pb = mesh.vertices[static_cast<std::size_t>(b)];
    EXPECT_NEAR((p - pa).norm() + (p - pb).norm(), (pb - pa).norm(), 1e-12);
    EXPECT_EQ(std::count(d.border_edges.begin(), d.border_edges.end(), std::array<int, 2>{a, b}), 0);
  }
  EXPECT_TRUE(diagnose(result.mesh).is_oriented_manifold());
}

/// A cone of `n` needles around one apex, each bent against the next, with lengths that differ.
TriangleMesh fan(int n, double degrees) {
  TriangleMesh mesh{{{0, 0, 0}}, {}};
  for (int i = 0; i <= n; ++i) {
    const double angle = i * degrees * std::numbers::pi / 180;
    const double length = 1 + 0.9 * std::sin(1.7 * i);
    mesh.vertices.push_back(length * Point(std::cos(angle), std::sin(angle), i % 2 == 0 ? 0.003 : -0.003));
    if (i > 0) mesh.triangles.push_back({0, i, i + 1});
  }
  return mesh;
}

/// Flat needles side by side, bent into waves along their short side.
TriangleMesh needles(double thickness) {
  TriangleMesh mesh = test::grid(6);
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    Point& p = mesh.vertices[v];
    p = Point(p.x() + 0.3 * std::sin(3.0 * static_cast<double>(v)), thickness * p.y(), 0.3 * std::cos(p.x()));
  }
  return mesh;
}

/// Two triangles over the faces of a ridge, each with an angle of nearly pi towards the ridge.
TriangleMesh caps(double height) {
  return {{{0, 0, 0}, {4, 0, 0}, {1, height, -height}, {3, -height, -height}, {2, 2, -2}, {2, -2, -2}},
          {{0, 1, 2}, {1, 0, 3}, {2, 1, 4}, {0, 2, 4}, {3, 0, 5}, {1, 3, 5}}};
}

/// Checks the surface's Steiner points against the bounds; returns how many there are.
std::size_t expect_within_bounds(const TriangleMesh& mesh, const DelaunayMesh& result) {
  const SteinerBounds bounds = steiner_bounds(mesh);
  std::map<std::array<int, 2>, std::vector<double>> on_edge;
  for (std::size_t i = 0; i < result.steiner_edges.size(); ++i) {
    const auto& ends = result.steiner_edges[i];
    const Point& p = result.mesh.vertices[mesh.vertices.size() + i];
    on_edge[ends].push_back((p - mesh.vertices[static_cast<std::size_t>(ends[0])]).norm());
  }
  constexpr double rounding = 1 - 1e-6;
  for (auto& [ends, distances] : on_edge) {
    const auto [a, b] = ends;
    const double length =
        (mesh.vertices[static_cast<std::size_t>(a)] - mesh.vertices[static_cast<std::size_t>(b)]).norm();
    std::sort(distances.begin(), distances.end());
    EXPECT_GE(distances.front(), rounding * bounds.end_gap);
    EXPECT_GE(length - distances.back(), rounding * bounds.end_gap);
    for (std::size_t i = 1; i < distances.size(); ++i)
      EXPECT_GE(distances[i] - distances[i - 1], rounding * bounds.inner_gap);
  }
  EXPECT_LE(static_cast<double>(result.steiner_edges.size()), bounds.most_points);
  return result.steiner_edges.size();
}

TEST(DelaunayMesh, HardCasesEndByThemselvesWithinTheBounds) {
  DelaunayMeshOptions unlimited;
  unlimited.shortest_piece = 0;
  unlimited.steiner_limit = 1e6;
  const std::vector<TriangleMesh> cases{fan(40, 5),    fan(40, 1), fan(200, 0.1), needles(0.1), needles(1e-2),
                                        needles(1e-4), caps(1e-2), caps(1e-4),    caps(1e-6),   stretched_bumps(9)};
  for (std::size_t i = 0; i < cases.size(); ++i) {
    SCOPED_TRACE("case " + std::to_string(i));
    const DelaunayMesh result = make_delaunay_mesh(cases[i], unlimited);
    EXPECT_EQ(result.edges_left, 0);
    EXPECT_TRUE(non_delaunay_edges(result.mesh).empty());
    EXPECT_TRUE(diagnose(result.mesh).is_oriented_manifold());
    EXPECT_NEAR(surface_area(result.mesh), surface_area(cases[i]), 1e-9 * surface_area(cases[i]));
    // Far fewer than the bound: a few per edge, and some more for each halving down to the thinnest place.
    const double halvings = -std::log2(std::sin(steiner_bounds(cases[i]).smallest_angle));
    EXPECT_LE(static_cast<double>(expect_within_bounds(cases[i], result)),
              6 * (2 + halvings) * static_cast<double>(cases[i].triangles.size()));
  }
}

TEST(DelaunayMesh, KeepsToTheLimitsAndCountsWhatIsLeft) {
  const TriangleMesh mesh = needles(1e-2);
  DelaunayMeshOptions options;
  options.steiner_limit = 0.5;
  const DelaunayMesh result = make_delaunay_mesh(mesh, options);
  EXPECT_LE(result.steiner_edges.size(), mesh.vertices.size() / 2);
  EXPECT_GT(result.edges_left, 0);
  EXPECT_EQ(static_cast<std::size_t>(result.edges_left), non_delaunay_edges(result.mesh).size());
  EXPECT_TRUE(diagnose(result.mesh).is_oriented_manifold());
}

TEST(DelaunayMesh, ScalesWithTheMesh) {
  TriangleMesh mesh = stretched_bumps(8);
  const DelaunayMesh small = make_delaunay_mesh(mesh);
  for (Point& p : mesh.vertices) p *= 64;
  const DelaunayMesh large = make_delaunay_mesh(mesh);
  EXPECT_EQ(small.mesh.triangles, large.mesh.triangles);
  for (std::size_t v = 0; v < small.mesh.vertices.size(); ++v)
    EXPECT_EQ(64 * small.mesh.vertices[v], large.mesh.vertices[v]);
}

TEST(DelaunayMesh, TheExactTestSeesTheLastBit) {
  // A square's diagonal is Delaunay; with one corner a last bit farther in, it is not.
  TriangleMesh square{{{0, 0, 0}, {1, 1, 0}, {0, 1, 0}, {1, 0, 0}}, {{0, 1, 2}, {1, 0, 3}}};
  EXPECT_TRUE(non_delaunay_edges(square, 0).empty());
  square.vertices[3].x() = std::nextafter(1.0, 0.0);
  EXPECT_EQ(non_delaunay_edges(square, 0).size(), 1U);
  EXPECT_TRUE(non_delaunay_edges(square).empty()) << "within the slack";
  square.vertices[3].x() = std::nextafter(1.0, 2.0);
  EXPECT_TRUE(non_delaunay_edges(square, 0).empty());
  // In space: folded along the diagonal, the angles stay.
  const double fold = 1 / std::sqrt(2.0);
  const TriangleMesh folded{{{0, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, fold * 1.001}}, {{0, 1, 2}, {1, 0, 3}}};
  EXPECT_TRUE(non_delaunay_edges(folded, 0).empty());
}

TEST(DelaunayMesh, AnotherTriangulationOfTheSamePiecesCounts) {
  const TriangleMesh input{{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}}, {{0, 1, 2}}};
  DelaunayMesh delaunay;
  delaunay.mesh = {{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 3}, {0, 3, 4}, {2, 4, 3}}};
  delaunay.steiner_edges = {{1, 2}, {0, 2}};
  delaunay.parent_triangle = {0, 0, 0};
  using Triangles = std::vector<Triangle>;
  const auto given = [&](const Triangles& dual) -> bool { return triangles_given_by_dual(input, delaunay, dual)[0]; };
  EXPECT_TRUE(given({{0, 1, 3}, {0, 3, 4}, {2, 4, 3}}));
  EXPECT_TRUE(given({{0, 1, 4}, {1, 3, 4}, {2, 4, 3}})) << "the other diagonal";
  EXPECT_FALSE(given({{0, 1, 3}, {0, 3, 4}})) << "a piece is missing";
  EXPECT_FALSE(given({{0, 1, 3}, {0, 4, 3}, {2, 4, 3}})) << "a piece is turned over";
  EXPECT_FALSE(given({{0, 1, 3}, {0, 3, 5}, {2, 4, 3}, {3, 4, 5}})) << "a root vertex stands within";
}

TEST(DelaunayMesh, ADelaunayMeshIsLeftAlone) {
  const TriangleMesh ball = test::sphere(3);
  ASSERT_TRUE(non_delaunay_edges(ball).empty());
  const DelaunayMesh result = make_delaunay_mesh(ball);
  EXPECT_TRUE(result.steiner_edges.empty());
  EXPECT_EQ(result.mesh.triangles, ball.triangles);
}

TEST(DelaunayMesh, FlippedNeighboursAreRefused) {
  const TriangleMesh turned{{{0, 0, 0}, {4, 0, 0}, {2, 1, 0}, {2, -1, 0}}, {{0, 1, 2}, {0, 1, 3}}};
  EXPECT_THROW(make_delaunay_mesh(turned), InputError);
}

TEST(StrongDelaunay, HoldsForADenseSphereAndFailsAfterAFlip) {
  TriangleMesh ball = test::sphere(3);
  EXPECT_TRUE(test_strong_delaunay(ball).holds());
  // Flip one edge: the two new triangles are not in the dual.
  const Triangle first = ball.triangles[0];
  for (std::size_t t = 1; t < ball.triangles.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      Triangle& second = ball.triangles[t];
      if (second[i] != first[1] || second[(i + 1) % 3] != first[0]) continue;
      const int d = second[(i + 2) % 3];
      second = {d, first[1], first[2]};
      ball.triangles[0] = {first[0], d, first[2]};
      const StrongDelaunay result = test_strong_delaunay(ball);
      EXPECT_FALSE(result.holds());
      EXPECT_EQ(result.missing, 2);
      EXPECT_EQ(result.additional, 2);
      return;
    }
  }
  FAIL() << "no neighbour found";
}

TEST(StrongDelaunay, AThinPlateIsDelaunayButNotStrong) {
  // Two sheets nearer to each other than their edges are long: cells reach through.
  TriangleMesh plate = test::grid(4);
  const auto n = static_cast<std::int32_t>(plate.vertices.size());
  TriangleMesh below = plate;
  for (Point& p : below.vertices) p += Point(0.3, 0.4, -0.05);
  for (const Point& p : below.vertices) plate.vertices.push_back(p);
  for (const auto& [a, b, c] : below.triangles) plate.triangles.push_back({a + n, c + n, b + n});
  EXPECT_FALSE(test_strong_delaunay(plate).holds());
}

}  // namespace
}  // namespace rhizodont
