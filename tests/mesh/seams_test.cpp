// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "mesh/seams.hpp"

#include "mesh/test_meshes.hpp"

#include <gtest/gtest.h>

namespace rhizodont {
namespace {

/// The dome cut in two along x = 0, the second half shifted.
TriangleMesh halves(const Eigen::Vector3d& shift) {
  const TriangleMesh dome = test::dome(3, 4);
  std::vector<bool> left;
  for (const Triangle& t : dome.triangles) {
    double x = 0;
    for (const int v : t) x += dome.vertices[static_cast<std::size_t>(v)].x();
    left.push_back(x < 0);
  }
  std::vector<bool> right = left;
  right.flip();
  return test::together(submesh(dome, left).mesh, submesh(dome, right).mesh, shift);
}

TEST(Seams, BothSidesOfACutAreFound) {
  const TriangleMesh mesh = halves({1e-3, 0, 0});
  const Seams seams = find_seams(mesh);
  EXPECT_EQ(seams.merged, static_cast<int>(mesh.vertices.size() - test::dome(3, 4).vertices.size()));
  EXPECT_NEAR(seams.largest_mm, 1e-3, 1e-9);
  for (std::size_t v = 0; v < seams.target.size(); ++v) EXPECT_LE(seams.target[v], static_cast<int>(v));
}

TEST(Seams, ASoupWhosePointsDifferInTheLastBitsIsOneSurfaceAgain) {
  const TriangleMesh dome = test::dome(4, 4);
  TriangleMesh soup;
  for (const Triangle& t : dome.triangles) {
    for (const int v : t) {
      const double k = static_cast<double>(soup.vertices.size() % 7) - 3;
      soup.vertices.push_back((1 + 1e-7 * k) * dome.vertices[static_cast<std::size_t>(v)]);
    }
    const auto n = static_cast<std::int32_t>(soup.vertices.size());
    soup.triangles.push_back({n - 3, n - 2, n - 1});
  }
  const Seams seams = find_seams(soup);
  EXPECT_EQ(seams.merged, static_cast<int>(soup.vertices.size() - dome.vertices.size()));
  EXPECT_LT(seams.largest_mm, 1e-5);
}

TEST(Seams, ABorderAloneIsNone) {
  EXPECT_EQ(find_seams(test::dome(3, 4)).merged, 0);
  EXPECT_EQ(find_seams(test::sphere(2, 4)).merged, 0);
  EXPECT_EQ(find_seams({}).merged, 0);
  EXPECT_EQ(find_seams(halves({0.1, 0, 0})).merged, 0) << "a gap, not a seam";
}

TEST(Seams, NoTriangleLosesASide) {
  // Needles whose short side is far below the tolerance.
  TriangleMesh mesh = halves({1e-4, 0, 0});
  for (const double size : {1e-1, 1e-3, 1e-5}) {
    TriangleMesh small = mesh;
    for (Point& p : small.vertices) p *= size;
    const Seams seams = find_seams(small);
    for (const Triangle& t : small.triangles) {
      const int a = seams.target[static_cast<std::size_t>(t[0])], b = seams.target[static_cast<std::size_t>(t[1])],
                c = seams.target[static_cast<std::size_t>(t[2])];
      EXPECT_TRUE(a != b && b != c && c != a);
    }
  }
}

TEST(Seams, VerticesThatHappenToBeNearAreLeft) {
  // Two corners of the border that nearly touch: no edge comes to lie on another one.
  TriangleMesh mesh = test::together(test::grid(3), test::grid(3), Point(3.001, 3.001, 0));
  EXPECT_EQ(find_seams(mesh).merged, 0);
}

}  // namespace
}  // namespace rhizodont
