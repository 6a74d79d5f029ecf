// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "rhizodont/measure.hpp"

#include "mesh/test_meshes.hpp"
#include "report/json.hpp"
#include "rhizodont/error.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace rhizodont {
namespace {

using test::cube, test::grid, test::sphere, test::together, test::torus;

TEST(Measure, CubeByFormula) {
  const MeshMeasures m = measure(cube());
  EXPECT_EQ(m.vertices, 8);
  EXPECT_EQ(m.edges, 18);
  EXPECT_EQ(m.triangles, 12);
  EXPECT_TRUE(m.closed);
  EXPECT_NEAR(m.volume, 1, 1e-14);
  EXPECT_NEAR(m.area, 6, 1e-14);
  EXPECT_NEAR(m.diagonal, std::sqrt(3), 1e-14);
  EXPECT_EQ(m.edge_min, 1);
  EXPECT_NEAR(m.edge_max, std::sqrt(2), 1e-15);
  EXPECT_NEAR(m.edge_mean, (12 + 6 * std::sqrt(2)) / 18, 1e-14);
  EXPECT_EQ(m.lowest, (std::array<double, 3>{0, 0, 0}));
  EXPECT_EQ(m.highest, (std::array<double, 3>{1, 1, 1}));
  EXPECT_NEAR(m.quality.theta_avg, 45, 1e-12);
  EXPECT_EQ(m.genus, 0);
  EXPECT_TRUE(m.defects.empty());
}

TEST(Measure, OpenMeshHasNoVolume) {
  const MeshMeasures m = measure(grid(3));
  EXPECT_FALSE(m.closed);
  EXPECT_EQ(m.volume, 0);
  EXPECT_EQ(m.border_edges, 12);
  EXPECT_EQ(m.border_loops, 1);
  EXPECT_TRUE(nlohmann::ordered_json(m)["size"]["volume_mm3"].is_null());
}

TEST(Measure, UnusedVerticesDoNotStretchTheBox) {
  TriangleMesh mesh = cube();
  mesh.vertices.emplace_back(100, 0, 0);
  const MeshMeasures m = measure(mesh);
  EXPECT_EQ(m.highest[0], 1);
  EXPECT_EQ(m.unreferenced_vertices, 1);
}

TEST(Measure, TopologyOfOtherShapes) {
  EXPECT_EQ(measure(torus(12, 9)).genus, 1);
  EXPECT_EQ(measure(torus(12, 9)).euler_number, 0);
  const MeshMeasures two = measure(together(cube(), sphere(2), {0.9, 0.9, 0.9}));
  EXPECT_EQ(two.components, 2);
  EXPECT_GT(two.self_intersections, 0);
}

TEST(Measure, ScalesAsItMust) {
  TriangleMesh large = torus(12, 9);
  for (Point& p : large.vertices) p *= 3;
  const MeshMeasures a = measure(torus(12, 9)), b = measure(large);
  EXPECT_NEAR(b.volume, 27 * a.volume, 1e-10);
  EXPECT_NEAR(b.area, 9 * a.area, 1e-10);
  EXPECT_NEAR(b.edge_mean, 3 * a.edge_mean, 1e-12);
  EXPECT_NEAR(b.quality.q_avg, a.quality.q_avg, 1e-14);
}

TEST(Measure, BadMeshesAreRefused) {
  EXPECT_THROW(measure({}), InputError);
  TriangleMesh mesh = cube();
  mesh.triangles[0][1] = 8;
  EXPECT_THROW(measure(mesh), InputError);
  mesh = cube();
  mesh.triangles[0][1] = mesh.triangles[0][0];
  EXPECT_THROW(measure(mesh), InputError);
  mesh = cube();
  mesh.vertices[0].z() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(measure(mesh), InputError);
}

}  // namespace
}  // namespace rhizodont
