// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "mesh/tunnels.hpp"

#include "mesh/handles.hpp"

#include "mesh/diagnosis.hpp"
#include "mesh/geometry.hpp"
#include "mesh/repair.hpp"
#include "mesh/test_meshes.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace rhizodont {
namespace {

/// The mesh with the triangles s and t replaced by a tube of three quads between them.
TriangleMesh with_tube(TriangleMesh mesh, std::size_t s, std::size_t t) {
  const Triangle from = mesh.triangles[s], to = mesh.triangles[t];
  Triangle far{to[0], to[2], to[1]};
  const auto distance = [&](int a, int b) {
    return (mesh.vertices[static_cast<std::size_t>(a)] - mesh.vertices[static_cast<std::size_t>(b)]).norm();
  };
  std::rotate(far.begin(),
              std::min_element(far.begin(), far.end(),
                               [&](int x, int y) { return distance(from[0], x) < distance(from[0], y); }),
              far.end());
  std::vector<bool> keep(mesh.triangles.size(), true);
  keep[s] = keep[t] = false;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    mesh.triangles.push_back({from[i], from[j], far[j]});
    mesh.triangles.push_back({from[i], far[j], far[i]});
  }
  keep.resize(mesh.triangles.size(), true);
  return submesh(mesh, keep).mesh;
}

double length(const TriangleMesh& mesh, const std::vector<int>& loop) {
  double sum = 0;
  for (std::size_t i = 0; i < loop.size(); ++i)
    sum += (mesh.vertices[static_cast<std::size_t>(loop[i])] -
            mesh.vertices[static_cast<std::size_t>(loop[(i + 1) % loop.size()])])
               .norm();
  return sum;
}

TEST(Tunnels, SurfacesWithoutHandlesHaveNone) {
  for (const TriangleMesh& mesh : {test::sphere(2, 4), test::dome(3, 4), test::grid(4)}) {
    EXPECT_EQ(handle_count(mesh), 0);
    EXPECT_TRUE(short_handle_loop(mesh).empty());
  }
  EXPECT_TRUE(short_handle_loop({}).empty());
}

TEST(Tunnels, OfATorusTheLoopGoesRoundTheTubeOnTheInside) {
  const TriangleMesh mesh = test::torus(40, 20, 3, 0.5);
  EXPECT_EQ(handle_count(mesh), 1);
  const std::vector<int> loop = short_handle_loop(mesh);
  EXPECT_NEAR(length(mesh, loop), 20 * 2 * 0.5 * std::sin(M_PI / 20), 1e-9);
  // The hole is narrower than the tube.
  const TriangleMesh thick = test::torus(40, 20, 3, 2);
  EXPECT_NEAR(length(thick, short_handle_loop(thick)), 40 * 2 * (3 - 2) * std::sin(M_PI / 40), 1e-9);
}

TEST(Tunnels, RepairCutsThemAndLeavesADiscWithHoles) {
  const TriangleMesh dome = test::dome(4, 4);
  const std::size_t n = dome.triangles.size();
  const TriangleMesh once = with_tube(dome, 10, n / 2), twice = with_tube(once, n / 4, 3 * n / 4);
  EXPECT_EQ(handle_count(once), 1);
  EXPECT_EQ(handle_count(twice), 2);
  for (const TriangleMesh& mesh : {once, twice}) {
    const RepairedMesh repaired = repair(mesh);
    EXPECT_TRUE(diagnose(repaired.mesh).is_oriented_manifold());
    EXPECT_EQ(handle_count(repaired.mesh), 0);
    EXPECT_GT(repaired.mesh.triangles.size(), 0.9 * static_cast<double>(n));
    bool told = false;
    for (const RepairStep& step : repaired.steps) told = told || step.action == RepairAction::tunnel_cut;
    EXPECT_TRUE(told);
  }
}

}  // namespace
}  // namespace rhizodont
