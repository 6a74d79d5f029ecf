// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "arch/clearance.hpp"

#include "arch/exact_distance.hpp"
#include "mesh/closest_on_triangle.hpp"
#include "mesh/test_meshes.hpp"
#include "rhizodont/error.hpp"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace rhizodont {
namespace {

using test::cube, test::sphere;

TriangleMesh moved(TriangleMesh mesh, const Eigen::Affine3d& motion) {
  for (Point& p : mesh.vertices) p = motion * p;
  return mesh;
}

TriangleMesh shifted(const TriangleMesh& mesh, const Eigen::Vector3d& shift) {
  return moved(mesh, Eigen::Affine3d(Eigen::Translation3d(shift)));
}

TriangleMesh box(const Point& low, const Point& high) {
  TriangleMesh mesh = cube();
  for (Point& p : mesh.vertices) p = low + p.cwiseProduct(high - low);
  return mesh;
}

/// About the z axis from z = 0 up, with middles in its ends.
TriangleMesh cylinder(int sides, double radius, double height) {
  TriangleMesh mesh;
  for (int k = 0; k < sides; ++k)
    for (const double z : {0.0, height}) {
      const double angle = 2 * std::numbers::pi * k / sides;
      mesh.vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
    }
  mesh.vertices.emplace_back(0, 0, 0);
  mesh.vertices.emplace_back(0, 0, height);
  for (int k = 0; k < sides; ++k) {
    const int a = 2 * k, b = 2 * ((k + 1) % sides);
    for (const Triangle& t : {Triangle{a, b, b + 1}, Triangle{a, b + 1, a + 1}, Triangle{b, a, 2 * sides},
                              Triangle{a + 1, b + 1, 2 * sides + 1}})
      mesh.triangles.push_back(t);
  }
  return mesh;
}

SolidSurface one_part(const TriangleMesh& mesh) {
  return SolidSurface(mesh, std::vector<int>(mesh.triangles.size()), 1);
}

double clearance(const TriangleMesh& a, const TriangleMesh& b) {
  return part_clearances(one_part(a), one_part(b))[0]->mm;
}

Eigen::Affine3d random_motion(std::mt19937& engine, double reach) {
  std::uniform_real_distribution<double> number(-1, 1);
  const Eigen::Quaterniond turn(number(engine), number(engine), number(engine), number(engine));
  const Eigen::Vector3d shift(number(engine), number(engine), number(engine));
  return Eigen::Translation3d(reach * shift) * Eigen::Affine3d(turn.normalized());
}

TEST(Clearance, BoxesByFormula) {
  const TriangleMesh a = box({0, 0, 0}, {2, 3, 4});
  EXPECT_DOUBLE_EQ(clearance(a, box({2.5, 1, 1}, {3, 2, 2})), 0.5);
  EXPECT_DOUBLE_EQ(clearance(a, box({2.3, 3.4, 1}, {3, 4, 2})), 0.5) << "edge to edge";
  EXPECT_DOUBLE_EQ(clearance(a, box({3, 5, 6}, {4, 6, 7})), 3) << "corner to corner";
  EXPECT_DOUBLE_EQ(clearance(a, box({1.75, 1, 1}, {3, 2, 2})), -0.25) << "pushed into a face";
  EXPECT_EQ(clearance(a, box({2, 1, 1}, {3, 2, 2})), 0) << "touching";
  EXPECT_DOUBLE_EQ(clearance(a, shifted(a, {1.75, 0, 0})), -0.25) << "sides in one plane";
}

TEST(Clearance, OneInTheOther) {
  const TriangleMesh big = box({0, 0, 0}, {10, 10, 10}), small = box({2, 4, 4}, {3, 5, 5});
  EXPECT_DOUBLE_EQ(clearance(big, small), -3) << "the deepest corner's depth";
  EXPECT_DOUBLE_EQ(clearance(small, big), -3);
  const double depth = clearance(sphere(3, 5), shifted(sphere(2, 1), {2, 0, 0}));
  EXPECT_NEAR(depth, -(5 - 2 + 1), 0.05);
}

TEST(Clearance, BarsThatCrossWithoutAVertexInside) {
  const TriangleMesh a = box({-5, -1, -1}, {5, 1, 1}), b = box({-1, -5, 0.5}, {1, 5, 2.5});
  EXPECT_NEAR(clearance(a, b), -0.5, 1e-12);
  EXPECT_NEAR(clearance(b, a), -0.5, 1e-12);
}

TEST(Clearance, BallsByFormula) {
  for (const double apart : {0.3, 1.0, 1.9, 2.5, 3.2, 3.5, 5.0, 30.0}) {
    const TriangleMesh a = sphere(4, 2), b = shifted(sphere(4, 1.2), Eigen::Vector3d(1, -2, 3).normalized() * apart);
    // Within the big ball it is the small one's point nearest to its middle that lies deepest.
    const double expected = std::abs(apart - 1.2) - 2, coarse = 0.02;  // mm: how flat triangles lie in the balls
    EXPECT_NEAR(clearance(a, b), expected, coarse) << apart;
    EXPECT_LE(clearance(b, a), expected + coarse) << apart;
  }
}

TEST(Clearance, CylindersByFormula) {
  const TriangleMesh a = cylinder(40, 2, 10);
  const Eigen::Affine3d lying =
      Eigen::Translation3d(0, 0, 5) * Eigen::AngleAxisd(0.5 * std::numbers::pi, Eigen::Vector3d::UnitX());
  // Vertices of both face each other: the smallest distance of the axes less both radii, exactly.
  EXPECT_NEAR(clearance(a, shifted(moved(cylinder(40, 1, 9), lying), {4, 4, 0})), 1, 1e-12);
  EXPECT_NEAR(clearance(a, shifted(cylinder(40, 1, 10), {3.25, 0, 0})), 0.25, 1e-12);
  EXPECT_NEAR(clearance(a, shifted(cylinder(40, 1, 10), {0.5, 0.25, 10.75})), 0.75, 1e-12) << "end to end";
}

TEST(Clearance, AsAllPairsOfTrianglesSayExactly) {
  std::mt19937 engine(3);
  for (const double reach : {2.0, 3.0, 50.0})
    for (int k = 0; k < 2; ++k) {
      const TriangleMesh a = moved(cube(), random_motion(engine, reach)),
                         b = moved(sphere(1), random_motion(engine, reach));
      const SolidSurface first = one_part(a), second = one_part(b);
      double smallest = std::numeric_limits<double>::infinity();
      for (int s = 0; s < 12; ++s)
        for (int t = 0; t < 32; ++t)
          smallest = std::min(smallest, test::exact_distance(first.corners(s), second.corners(t)));
      const Approach found = *part_clearances(first, second)[0];
      if (smallest > 0 && found.mm > 0) {
        EXPECT_NEAR(found.mm, smallest, 1e-13 * (1 + reach));
        EXPECT_NEAR((found.on_first - found.on_second).norm(), found.mm, 1e-12);
        EXPECT_FALSE(part_clearances(first, second, 0.99 * smallest)[0]);
        EXPECT_TRUE(part_clearances(first, second, 1.01 * smallest)[0]);
      } else {
        EXPECT_LE(found.mm, 0);
      }
    }
}

TEST(Clearance, HangsNeitherOnOrderNorOnPlace) {
  std::mt19937 engine(4);
  const TriangleMesh shape = sphere(3, 3), other = cylinder(24, 1, 6);
  for (const double apart : {1.0, 2.5, 3.9, 4.5}) {
    const TriangleMesh partner = shifted(other, {apart, 0.3, -2});
    const double expected = clearance(shape, partner);
    EXPECT_EQ(expected < 0, apart < 3.95);
    EXPECT_NEAR(clearance(partner, shape), expected, 1e-13);
    const Eigen::Affine3d motion = random_motion(engine, 80);
    EXPECT_NEAR(clearance(moved(shape, motion), moved(partner, motion)), expected, 1e-12);
    TriangleMesh mixed = shape;
    std::vector<int> place(shape.vertices.size());
    for (std::size_t v = 0; v < place.size(); ++v) place[v] = static_cast<int>(v);
    std::shuffle(place.begin(), place.end(), engine);
    for (std::size_t v = 0; v < place.size(); ++v)
      mixed.vertices[static_cast<std::size_t>(place[v])] = shape.vertices[v];
    for (Triangle& t : mixed.triangles) {
      for (int& v : t) v = place[static_cast<std::size_t>(v)];
      std::rotate(t.begin(), t.begin() + engine() % 3, t.end());
    }
    std::shuffle(mixed.triangles.begin(), mixed.triangles.end(), engine);
    EXPECT_NEAR(clearance(mixed, partner), expected, 1e-13);
  }
}

/// A ball's upper half is crown.
std::vector<VertexSource> upper_is_scan(const TriangleMesh& mesh, double level) {
  std::vector<VertexSource> source;
  for (const Point& p : mesh.vertices)
    source.push_back(p.z() >= level - 1e-9 ? VertexSource::scan : VertexSource::predicted);
  return source;
}

TEST(Clearance, PartsByTheirOwnSurfaces) {
  // Crown above z = 5, the second one's above z = 2.
  TriangleMesh first = cylinder(32, 1, 10), second = shifted(cylinder(32, 1, 4), {4, 0, 0});
  for (std::size_t v = 0; v < first.vertices.size(); ++v)
    if (first.vertices[v].z() > 5) first.vertices[v] -= Eigen::Vector3d(0.5, 0, 0);  // leans away
  const SolidSurface one = tooth_surface(first, upper_is_scan(first, 5));
  const SolidSurface two = tooth_surface(second, upper_is_scan(second, 2));
  const Clearance found = clearance_of(one, two);
  // The crowns are the upper ends: the sides have corners below, too. That of the first lies 6 mm higher.
  EXPECT_NEAR(found.crown_crown->mm, std::hypot(2.5, 6), 1e-12);
  EXPECT_NEAR(found.root_root->mm, 2, 1e-12);
  EXPECT_NEAR(found.crown_root->mm, std::hypot(2.5, 6), 1e-12) << "the end's rim is the side's, too";
  EXPECT_EQ(found.whole()->mm, found.root_root->mm);
  const Clearance turned = clearance_of(two, one);
  EXPECT_NEAR(turned.crown_root->mm, found.root_crown->mm, 1e-13);
  EXPECT_NEAR(turned.root_crown->mm, found.crown_root->mm, 1e-13);
  EXPECT_EQ(turned.root_to_crown()->mm, std::min(found.crown_root->mm, found.root_crown->mm));
}

TEST(Clearance, DepthsBelongToThePartsConcerned) {
  const TriangleMesh ball = sphere(4, 2), low = shifted(ball, {3.5, 0, -1});
  const SolidSurface a = tooth_surface(ball, upper_is_scan(ball, 1)), b = tooth_surface(low, upper_is_scan(low, 0.5));
  const Clearance found = clearance_of(a, b);
  EXPECT_NEAR(found.root_root->mm, std::hypot(3.5, 1) - 4, 0.02);
  EXPECT_GT(found.crown_crown->mm, 0);
  EXPECT_EQ(found.whole()->mm, found.root_root->mm);
  const SolidSurface no_root = tooth_surface(low, std::vector<VertexSource>(low.vertices.size(), VertexSource::scan));
  EXPECT_FALSE(clearance_of(a, no_root).root_root);
  EXPECT_FALSE(clearance_of(a, no_root).crown_root);
  EXPECT_LT(clearance_of(a, no_root).root_crown->mm, 0);
}

/// Inside by the solid angle that the surface is seen under, an oracle of its own.
bool is_inside(const TriangleMesh& mesh, const Point& p) {
  double angle = 0;
  for (const Triangle& t : mesh.triangles) {
    std::array<Eigen::Vector3d, 3> to;
    for (std::size_t i = 0; i < 3; ++i) to[i] = (mesh.vertices[static_cast<std::size_t>(t[i])] - p).normalized();
    angle += 2 * std::atan2(to[0].dot(to[1].cross(to[2])), 1 + to[0].dot(to[1]) + to[1].dot(to[2]) + to[2].dot(to[0]));
  }
  return angle > 2 * std::numbers::pi;
}

TEST(SolidSurfaceTest, SignedDistancesOfConcaveAndSharpSolids) {
  std::mt19937 engine(5);
  std::uniform_real_distribution<double> number(-3.2, 3.2);
  for (const TriangleMesh& mesh : {test::torus(24, 10), cylinder(7, 2, 0.05), test::tetrahedron()}) {
    const SolidSurface solid = one_part(mesh);
    for (int k = 0; k < 400; ++k) {
      const Point p = Point(number(engine), number(engine), 0.3 * number(engine));
      double nearest = std::numeric_limits<double>::infinity();
      for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
        const auto [a, b, c] = solid.corners(t);
        nearest = std::min(nearest, std::sqrt(closest_on_triangle(p, a, b, c).squared_distance));
      }
      const SignedDistance found = *solid.signed_distance(p);
      EXPECT_NEAR(found.mm, is_inside(mesh, p) ? -nearest : nearest, 1e-13);
      EXPECT_NEAR((found.on_surface - p).norm(), nearest, 1e-13);
      EXPECT_EQ(solid.signed_distance(p, 1.001 * nearest)->mm, found.mm);
    }
  }
}

TEST(SolidSurfaceTest, RefusesWhatIsNoSolid) {
  const auto parts = [](const TriangleMesh& mesh) { return std::vector<int>(mesh.triangles.size()); };
  const TriangleMesh open = test::dome(2);
  EXPECT_THROW(SolidSurface(open, parts(open), 1), InputError);
  EXPECT_THROW(SolidSurface({}, {}, 1), InputError);
  TriangleMesh turned = cube();
  std::swap(turned.triangles[3][0], turned.triangles[3][1]);
  EXPECT_THROW(SolidSurface(turned, parts(turned), 1), InputError);
  TriangleMesh wild = cube();
  wild.vertices[2].y() = std::nan("");
  EXPECT_THROW(SolidSurface(wild, parts(wild), 1), InputError);
  TriangleMesh beyond = cube();
  beyond.triangles[0][0] = 8;
  EXPECT_THROW(SolidSurface(beyond, parts(beyond), 1), InputError);
  EXPECT_THROW(tooth_surface(beyond, std::vector<VertexSource>(8)), InputError);
  EXPECT_THROW(SolidSurface(cube(), {}, 1), UsageError);
  EXPECT_THROW(SolidSurface(cube(), std::vector<int>(12, 1), 1), UsageError);
  EXPECT_THROW(SolidSurface(cube(), std::vector<int>(12), 0), UsageError);
  EXPECT_THROW(tooth_surface(cube(), std::vector<VertexSource>(7)), UsageError);
}

TEST(NeighbourClearances, OfWhateverStandsNear) {
  // 0 and 1 side by side, then a gap, 3; 2 stands behind 1 as in a crowded arch; 4 is missing, 5 far away.
  std::vector<SolidSurface> surfaces;
  for (const Eigen::Vector3d& middle : {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(5, 0, 0), Eigen::Vector3d(5, 4.5, 0),
                                        Eigen::Vector3d(16, 0, 0), Eigen::Vector3d(60, 0, 0)}) {
    const TriangleMesh ball = shifted(sphere(2, 2), middle);
    surfaces.push_back(tooth_surface(ball, upper_is_scan(ball, 0)));
  }
  const std::vector<const SolidSurface*> teeth{&surfaces[0], &surfaces[1], &surfaces[2],
                                               &surfaces[3], nullptr,      &surfaces[4]};
  const auto found = neighbour_clearances(teeth);
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (const auto& n : found) pairs.emplace_back(n.first, n.second);
  const std::vector<std::pair<std::size_t, std::size_t>> expected{{0, 1}, {0, 2}, {1, 2}, {1, 3}, {2, 3}};
  EXPECT_EQ(pairs, expected);
  EXPECT_NEAR(found[0].clearance.whole()->mm, 1, 1e-12);
  EXPECT_NEAR(found[3].clearance.whole()->mm, 7, 1e-12);
  NeighbourOptions near;
  near.within = 2;
  EXPECT_EQ(neighbour_clearances(teeth, near).size(), 2U);
  near.within = 0;
  EXPECT_THROW(neighbour_clearances(teeth, near), UsageError);
}

TEST(VertexClearances, SignedAndBounded) {
  const TriangleMesh one = sphere(3, 2), two = shifted(sphere(4, 2), {3.5, 0, 0}), far = shifted(one, {40, 0, 0});
  const SolidSurface a = one_part(one), b = one_part(two), c = one_part(far);
  const auto found = vertex_clearances({&a, nullptr, &b, &c}, 3);
  ASSERT_EQ(found[0].size(), one.vertices.size());
  EXPECT_TRUE(found[1].empty());
  int inside = 0;
  for (std::size_t v = 0; v < one.vertices.size(); ++v) {
    const double expected = std::min(3.0, (one.vertices[v] - Point(3.5, 0, 0)).norm() - 2);
    EXPECT_NEAR(found[0][v], expected, 0.01);
    inside += found[0][v] < 0;
  }
  EXPECT_GT(inside, 0);
  for (const double mm : found[3]) EXPECT_EQ(mm, 3);
  tbb::task_arena alone(1);
  alone.execute([&] { EXPECT_EQ(vertex_clearances({&a, nullptr, &b, &c}, 3), found); });
}

}  // namespace
}  // namespace rhizodont
