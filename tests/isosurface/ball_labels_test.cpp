// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "isosurface/ball_labels.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <set>

#include "mesh/diagnosis.hpp"
#include "mesh/geometry.hpp"
#include "rhizodont/error.hpp"

namespace rhizodont {
namespace {

FieldSample ball(const Point& p, const Point& centre, double radius) {
  return {radius * radius - (p - centre).squaredNorm(), -2.0 * (p - centre)};
}

/// A torus around z with a ring of radius 2.
FieldSample torus(const Point& p, double section) {
  const double ring = p.head<2>().norm() + 1e-12;
  const Eigen::Vector3d gradient(-2.0 * (ring - 2.0) * p.x() / ring, -2.0 * (ring - 2.0) * p.y() / ring, -2.0 * p.z());
  return {section * section - (ring - 2.0) * (ring - 2.0) - p.z() * p.z(), gradient};
}

FieldSample larger(const FieldSample& a, const FieldSample& b) { return a.value > b.value ? a : b; }

Isosurface as_ball(const ScalarField& field, const Point& seed, double e) {
  IsosurfaceOptions options;
  options.e = e;
  options.origin = Point(0.013, -0.021, 0.008);
  options.as_ball = true;
  const std::vector<Point> seeds{seed};
  return grad_normal(field, 0.0, seeds, options);
}

TEST(SimplePoint, IsOneWithConnectedInsideAndOutsideNeighbours) {
  EXPECT_FALSE(is_simple(0));
  EXPECT_FALSE(is_simple((1U << 14) - 1));
  const auto& neighbours = lattice_neighbours();
  for (std::size_t n = 0; n < 14; ++n) EXPECT_TRUE(is_simple(1U << n));
  // Opposite neighbours: a bridge. The ring between them: a tunnel.
  for (std::size_t a = 0; a < 14; ++a)
    for (std::size_t b = 0; b < 14; ++b) {
      if (neighbours[a][0] != -neighbours[b][0] || neighbours[a][1] != -neighbours[b][1] ||
          neighbours[a][2] != -neighbours[b][2])
        continue;
      const std::uint32_t pair = (1U << a) | (1U << b);
      EXPECT_FALSE(is_simple(pair));
      EXPECT_FALSE(is_simple(((1U << 14) - 1) & ~pair));
    }
}

TEST(SimplePoint, KnowsTheNeighboursOfTheTiling) {
  std::set<LatticeVertex> of_cells;
  for (const LatticeCell& cell : GoldbergTiling::around({0, 0, 0}))
    for (const LatticeVertex& corner : GoldbergTiling::corners(cell)) of_cells.insert(corner);
  of_cells.erase({0, 0, 0});
  const auto& neighbours = lattice_neighbours();
  EXPECT_EQ(of_cells, std::set<LatticeVertex>(neighbours.begin(), neighbours.end()));
}

TEST(AsBall, LeavesABallAsItIs) {
  const ScalarField field = [](const Point& p) { return ball(p, Point::Zero(), 2.0); };
  const Isosurface surface = as_ball(field, Point(2.0, 0.0, 0.0), 0.3);
  EXPECT_EQ(surface.relabelled_vertices, 0U);
  EXPECT_EQ(surface.euler_number, 2);
}

TEST(AsBall, FillsANarrowTunnel) {
  const double section = 1.85;  // the hole is 0.3 across
  const ScalarField field = [=](const Point& p) { return torus(p, section); };
  const Isosurface surface = as_ball(field, Point(2.0 + section, 0.0, 0.0), 0.25);
  EXPECT_TRUE(diagnose(surface.mesh).is_closed_solid());
  EXPECT_GT(surface.relabelled_vertices, 0U);
  const double full = 2.0 * std::numbers::pi * std::numbers::pi * 2.0 * section * section;
  EXPECT_NEAR(volume(surface.mesh) / full, 1.0, 0.03);
}

TEST(AsBall, CutsAThinBridge) {
  // A ring as thin as the tiling on a large ball.
  const ScalarField field = [](const Point& p) { return larger(ball(p, Point(-4.0, 0.0, 0.0), 3.0), torus(p, 0.25)); };
  const Isosurface surface = as_ball(field, Point(-7.0, 0.0, 0.0), 0.4);
  EXPECT_TRUE(diagnose(surface.mesh).is_closed_solid());
  EXPECT_GE(surface.relabelled_vertices, 1U) << "as it is the ring makes a tunnel";
  EXPECT_LE(surface.relabelled_vertices, 4U);
  EXPECT_EQ(surface.euler_number, 2);
  // The ball stays whole, and the ring is not filled: its hole would take 8 mm^3 and more.
  EXPECT_NEAR(volume(surface.mesh), 4.0 / 3 * std::numbers::pi * 27, 4);
}

TEST(AsBall, RefusesToCloseAWideTunnel) {
  const ScalarField field = [](const Point& p) { return torus(0.5 * p, 1.0); };  // section of 12 mm^2, hole of 12 mm^2
  EXPECT_THROW(as_ball(field, Point(6.0, 0.0, 0.0), 0.4), NoResultError);
}

}  // namespace
}  // namespace rhizodont
