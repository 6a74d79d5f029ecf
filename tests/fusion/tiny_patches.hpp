// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fusion/restore.hpp"
#include "mesh/diagnosis.hpp"
#include "mesh/geometry.hpp"
#include "mesh/self_intersection.hpp"
#include "mesh/test_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

// Crowns and teeth of a few triangles, whose right outcome is known, and ways to look at the same thing otherwise.
namespace rhizodont::test {

/// Upper half of the octahedron: border vertices 0..3 around the equator, counterclockwise from above, and 4 at the
/// top.
inline TriangleMesh pyramid() {
  return {{{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}, {0, 0, 1}}, {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}}};
}

/// The four triangles between the pyramid's border and a vertex under it.
inline std::vector<Triangle> lower_half(int bottom) {
  return {{1, 0, bottom}, {2, 1, bottom}, {3, 2, bottom}, {0, 3, bottom}};
}

/// Each written with its lowest index first, sorted: the same for the same triangles in any order.
inline std::vector<Triangle> as_set(std::vector<Triangle> triangles) {
  for (Triangle& t : triangles) std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

/// As a set of triangles between places: the same for any numbering of vertices. Coordinates in steps of 1e-9.
inline std::vector<std::array<std::array<long long, 3>, 3>> as_places(const TriangleMesh& mesh) {
  std::vector<std::array<std::array<long long, 3>, 3>> all;
  for (const Triangle& t : mesh.triangles) {
    std::array<std::array<long long, 3>, 3> corners{};
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t k = 0; k < 3; ++k)
        corners[i][k] = std::llround(1e9 * mesh.vertices[static_cast<std::size_t>(t[i])][static_cast<Eigen::Index>(k)]);
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    all.push_back(corners);
  }
  std::sort(all.begin(), all.end());
  return all;
}

/// A turn and a shift.
struct Motion {
  Eigen::Matrix3d turn = Eigen::AngleAxisd(0.83, Eigen::Vector3d(3, -1, 2).normalized()).toRotationMatrix();
  Eigen::Vector3d shift{4, -7, 2.5};

  Point operator()(const Point& p) const { return turn * p + shift; }
  TriangleMesh operator()(TriangleMesh mesh) const {
    for (Point& p : mesh.vertices) p = (*this)(p);
    return mesh;
  }
};

/// Seen in a mirror: x turned over, and so every triangle.
inline std::vector<Triangle> mirrored(std::vector<Triangle> triangles) {
  for (Triangle& t : triangles) std::swap(t[1], t[2]);
  return triangles;
}
inline TriangleMesh mirrored(TriangleMesh mesh) {
  for (Point& p : mesh.vertices) p.x() = -p.x();
  mesh.triangles = mirrored(std::move(mesh.triangles));
  return mesh;
}

/// An order at random: entry i says where i goes.
inline std::vector<int> random_order(std::size_t size, unsigned seed) {
  std::vector<int> order(size);
  std::iota(order.begin(), order.end(), 0);
  std::mt19937 random(seed);
  std::shuffle(order.begin(), order.end(), random);
  return order;
}

/// The mesh with vertex v at number order[v].
inline TriangleMesh renumbered(const TriangleMesh& mesh, const std::vector<int>& order) {
  TriangleMesh other = mesh;
  for (std::size_t v = 0; v < order.size(); ++v) other.vertices[static_cast<std::size_t>(order[v])] = mesh.vertices[v];
  for (Triangle& t : other.triangles)
    for (std::int32_t& v : t) v = order[static_cast<std::size_t>(v)];
  return other;
}

/// Radians, of the triangles from the given one on.
inline double smallest_angle_of(const TriangleMesh& mesh, std::size_t first = 0) {
  double smallest = std::numeric_limits<double>::max();
  for (std::size_t t = first; t < mesh.triangles.size(); ++t) {
    const auto angles = triangle_angles(mesh, t);
    smallest = std::min(smallest, *std::min_element(angles.begin(), angles.end()));
  }
  return smallest;
}

/// Closed, manifold, oriented outwards, one piece without handles that does not cut itself.
inline void expect_ball(const TriangleMesh& mesh) {
  const Diagnosis found = diagnose(mesh);
  EXPECT_TRUE(found.is_closed_solid());
  EXPECT_TRUE(found.misoriented_edges.empty());
  EXPECT_EQ(found.components, 1);
  EXPECT_EQ(found.euler_number, 2);
  EXPECT_GT(volume(mesh), 0);
  EXPECT_TRUE(self_intersecting_triangles(mesh).empty());
}

/// The tooth's first vertices and triangles are the crown's, bit for bit and in order.
inline void expect_crown_kept(const TriangleMesh& crown, const JoinedTooth& tooth) {
  EXPECT_EQ(tooth.crown_vertices, static_cast<int>(crown.vertices.size()));
  EXPECT_EQ(tooth.crown_triangles, static_cast<int>(crown.triangles.size()));
  ASSERT_GE(tooth.mesh.vertices.size(), crown.vertices.size());
  ASSERT_GE(tooth.mesh.triangles.size(), crown.triangles.size());
  EXPECT_TRUE(std::equal(crown.vertices.begin(), crown.vertices.end(), tooth.mesh.vertices.begin()));
  EXPECT_TRUE(std::equal(crown.triangles.begin(), crown.triangles.end(), tooth.mesh.triangles.begin()));
}

}  // namespace rhizodont::test
