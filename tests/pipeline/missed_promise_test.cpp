// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/missed_promise.hpp"

#include "mesh/quality.hpp"
#include "mesh/test_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace rhizodont {
namespace {

/// Figures over the triangles from `first` on, told apart by whether they touch the first `crown_vertices` vertices.
NewTriangleFigures figures(const TriangleMesh& mesh, std::size_t first, int crown_vertices) {
  std::vector<bool> all, inner, border;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    bool touches = false;
    for (const int v : mesh.triangles[t]) touches = touches || v < crown_vertices;
    all.push_back(t >= first);
    inner.push_back(t >= first && !touches);
    border.push_back(t >= first && touches);
  }
  return {quality(mesh, all), quality(mesh, inner), quality(mesh, border)};
}

TEST(MissedPromise, SaysNothingWhereItIsKept) {
  const TriangleMesh ball = test::sphere(0, 5);
  EXPECT_TRUE(where_promise_three_is_missed(ball, {0, 1, 2}, 4, figures(ball, 4, 3)).empty());
}

TEST(MissedPromise, NamesPlaceVerticesAndAngle) {
  // The crown's first vertex, number 70 of the input, is moved until triangles beside it are flat.
  TriangleMesh ball = test::sphere(3, 5);
  const Triangle t = ball.triangles.back();
  std::vector<int> kept;
  for (int v = 0; v <= t[0]; ++v) kept.push_back(70 + v);
  ball.vertices[static_cast<std::size_t>(t[0])] =
      0.5 * (ball.vertices[static_cast<std::size_t>(t[1])] + ball.vertices[static_cast<std::size_t>(t[2])]) +
      Eigen::Vector3d(0, 0, 0.01);
  const auto places = where_promise_three_is_missed(ball, kept, 0, figures(ball, 0, t[0] + 1));
  ASSERT_FALSE(places.empty());
  const std::string& sentence = places.front().sentence;
  EXPECT_NE(sentence.find("at the crown's border"), std::string::npos);
  EXPECT_NE(sentence.find("degrees, at ("), std::string::npos) << sentence;
  const std::vector<int>& beside = places.front().crown_vertices;
  EXPECT_NE(std::find(beside.begin(), beside.end(), 70 + t[0]), beside.end());
}

TEST(MissedPromise, TellsAnUnevenMeshByItsFigures) {
  const TriangleMesh ball = test::sphere(3, 5);
  NewTriangleFigures found = figures(ball, 0, 0);
  found.all->q_avg = 0.91;
  const auto places = where_promise_three_is_missed(ball, {}, 0, found);
  ASSERT_EQ(places.size(), 1U);
  EXPECT_NE(places.front().sentence.find("0.910"), std::string::npos) << places.front().sentence;
  EXPECT_TRUE(places.front().crown_vertices.empty());
}

}  // namespace
}  // namespace rhizodont
