// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "skirt/spikes.hpp"

#include "operators/surfaces.hpp"
#include "rhizodont/error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace rhizodont {
namespace {

int dropped(const std::vector<bool>& keep) { return static_cast<int>(std::count(keep.begin(), keep.end(), false)); }

/// A fan of 12 triangles around a tip: a cone whose slant makes `opening` degrees across, of slant length 1.
TriangleMesh cone(double opening) {
  const double half = opening / 2 * std::numbers::pi / 180;
  TriangleMesh mesh{{Point(0, 0, std::cos(half))}, {}};
  for (int i = 0; i < 12; ++i) {
    const double turn = i * std::numbers::pi / 6;
    mesh.vertices.emplace_back(std::sin(half) * std::cos(turn), std::sin(half) * std::sin(turn), 0);
    mesh.triangles.push_back({0, 1 + i, 1 + (i + 1) % 12});
  }
  return mesh;
}

TEST(Spikes, AConeOfSixtyDegreesIsTheBound) {
  SpikeOptions tips_only;
  tips_only.flap = 0;
  EXPECT_EQ(dropped(triangles_without_spikes(cone(62), tips_only)), 0);
  EXPECT_EQ(dropped(triangles_without_spikes(cone(58), tips_only)), 12);
}

TEST(Spikes, APulledVertexGoesAndNothingElse) {
  TriangleMesh sheet = test::rectangle(20, 20, 4, 4);
  EXPECT_EQ(dropped(triangles_without_spikes(sheet)), 0) << "corners of 90 degrees are no flaps";
  const auto middle =
      static_cast<std::size_t>(std::min_element(sheet.vertices.begin(), sheet.vertices.end(),
                                                [](const Point& a, const Point& b) {
                                                  return (a - Point(2, 2, 0)).norm() < (b - Point(2, 2, 0)).norm();
                                                }) -
                               sheet.vertices.begin());
  sheet.vertices[middle].z() += 0.1;  // a bump of half an edge
  EXPECT_EQ(dropped(triangles_without_spikes(sheet)), 0);
  sheet.vertices[middle].z() += 0.7;
  const std::vector<bool> keep = triangles_without_spikes(sheet);
  for (std::size_t t = 0; t < keep.size(); ++t) {
    const Triangle& of = sheet.triangles[t];
    EXPECT_EQ(keep[t], std::find(of.begin(), of.end(), static_cast<int>(middle)) == of.end());
  }
}

TEST(Spikes, AStripOfTrianglesAtTheBorderIsEatenFromItsTip) {
  TriangleMesh sheet = test::rectangle(10, 10, 4, 4);
  const auto plain = sheet.triangles.size();
  // A pointed flap of two triangles, from the middle of an edge of the border.
  int a = -1, b = -1;
  for (std::size_t v = 0; v < sheet.vertices.size(); ++v) {
    if ((sheet.vertices[v] - Point(1.6, 0, 0)).norm() < 1e-9) a = static_cast<int>(v);
    if ((sheet.vertices[v] - Point(2.0, 0, 0)).norm() < 1e-9) b = static_cast<int>(v);
  }
  ASSERT_GE(std::min(a, b), 0);
  const int c = static_cast<int>(sheet.vertices.size());
  sheet.vertices.emplace_back(1.75, -1, 0);
  sheet.vertices.emplace_back(1.85, -1.8, 0);
  sheet.triangles.push_back({a, c, b});
  sheet.triangles.push_back({b, c, c + 1});
  const std::vector<bool> keep = triangles_without_spikes(sheet);
  EXPECT_EQ(dropped(keep), 2);
  EXPECT_FALSE(keep[plain] || keep[plain + 1]);
}

TEST(Spikes, CornersOfTheBorderStayAndNeedlesGo) {
  const auto triangle = [](double height) {
    // Two like triangles foot to foot: blunt at the foot, both tips at the border.
    return TriangleMesh{{{-1, 0, 0}, {1, 0, 0}, {0, height, 0}, {0, -height, 0}}, {{0, 1, 2}, {1, 0, 3}}};
  };
  EXPECT_EQ(dropped(triangles_without_spikes(triangle(1.7))), 0) << "61 degrees";
  EXPECT_EQ(dropped(triangles_without_spikes(triangle(1.8))), 2) << "58 degrees";
}

TEST(Spikes, AFinIsTakenOffAndARidgeIsNot) {
  // A roof, open at its gables, whose ridge is bent by `bend` degrees.
  const auto roof = [](double bend) {
    TriangleMesh sheet = test::rectangle(8, 8, 4, 4);
    const double slope = std::tan(bend / 2 * std::numbers::pi / 180);
    for (Point& p : sheet.vertices) p.z() = -slope * std::abs(p.x() - 2);
    return sheet;
  };
  SpikeOptions one_round;
  one_round.rounds = 1;
  EXPECT_EQ(dropped(triangles_without_spikes(roof(90))), 0);
  const TriangleMesh sharp = roof(100);
  const std::vector<bool> keep = triangles_without_spikes(sharp, one_round);
  EXPECT_GT(dropped(keep), 0);
  for (std::size_t t = 0; t < keep.size(); ++t) {
    const Triangle& of = sharp.triangles[t];
    const bool at_an_end = std::any_of(of.begin(), of.end(), [&](int v) {
      const Point& p = sharp.vertices[static_cast<std::size_t>(v)];
      return std::abs(p.x() - 2) < 1e-9 && std::abs(std::abs(p.y() - 2) - 2) < 1e-9;
    });
    EXPECT_EQ(keep[t], !at_an_end);
  }
  TriangleMesh folded = sharp;
  for (Point& p : folded.vertices) p.z() = -p.z();
  EXPECT_EQ(triangles_without_spikes(folded, one_round), keep) << "folded inwards";
}

TEST(Spikes, BadOptionsAreRefused) {
  const TriangleMesh sheet = test::rectangle(2, 2, 1, 1);
  for (const SpikeOptions& bad :
       {SpikeOptions{-1, 40, 95, 3}, SpikeOptions{361, 40, 95, 3}, SpikeOptions{180, 181, 95, 3},
        SpikeOptions{180, 40, 0, 3}, SpikeOptions{180, 40, 181, 3}, SpikeOptions{180, 40, 95, 0},
        SpikeOptions{std::nan(""), 40, 95, 3}, SpikeOptions{180, 40, std::nan(""), 3}})
    EXPECT_THROW(triangles_without_spikes(sheet, bad), UsageError);
}

}  // namespace
}  // namespace rhizodont
