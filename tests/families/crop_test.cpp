// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// What needs no templates: random numbers, junction heights, gum lines and cutting, on a ball.
#include "base/random_stream.hpp"
#include "families/crown_crop.hpp"
#include "families/scanner_mesh.hpp"
#include "families/synthetic_files.hpp"
#include "mesh/diagnosis.hpp"
#include "mesh/geometry.hpp"
#include "rhizodont/error.hpp"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

namespace rhizodont {
namespace {

constexpr int rings = 60, sectors = 90;

// A ball around the origin, triangulated by parallels and meridians.
SyntheticTooth ball(double radius) {
  SyntheticTooth tooth;
  auto& [vertices, triangles] = tooth.mesh;
  vertices.emplace_back(0, 0, radius);
  for (int i = 1; i < rings; ++i) {
    for (int j = 0; j < sectors; ++j) {
      const double a = std::numbers::pi * i / rings, b = 2 * std::numbers::pi * j / sectors;
      vertices.emplace_back(radius * std::sin(a) * std::cos(b), radius * std::sin(a) * std::sin(b),
                            radius * std::cos(a));
    }
  }
  vertices.emplace_back(0, 0, -radius);
  const auto at = [](int i, int j) { return 1 + (i - 1) * sectors + j % sectors; };
  const int last = static_cast<int>(vertices.size()) - 1;
  for (int j = 0; j < sectors; ++j) {
    triangles.push_back({0, at(1, j), at(1, j + 1)});
    for (int i = 1; i + 1 < rings; ++i) {
      triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
    triangles.push_back({at(rings - 1, j), last, at(rings - 1, j + 1)});
  }
  tooth.junction.half_width = {radius, radius};
  tooth.crown.assign(vertices.size(), 1);
  tooth.root.assign(vertices.size(), -1);
  tooth.crown_height = tooth.root_length = radius;
  return tooth;
}

void expect_disc(const TriangleMesh& mesh) {
  const Diagnosis diagnosis = diagnose(mesh);
  EXPECT_TRUE(diagnosis.is_oriented_manifold());
  EXPECT_EQ(diagnosis.components, 1);
  EXPECT_EQ(diagnosis.border_loop_count, 1);
  EXPECT_EQ(diagnosis.euler_number, 1);
  EXPECT_TRUE(diagnosis.unreferenced_vertices.empty());
}

TEST(RandomStream, isUniformAndNormal) {
  RandomStream random(42);
  double sum = 0, squares = 0, normal_sum = 0, normal_squares = 0;
  constexpr int count = 200000;
  for (int i = 0; i < count; ++i) {
    const double u = random.uniform();
    ASSERT_TRUE(u >= 0 && u < 1);
    sum += u, squares += u * u;
    const double n = random.normal();
    normal_sum += n, normal_squares += n * n;
  }
  EXPECT_NEAR(sum / count, 0.5, 0.004);
  EXPECT_NEAR(squares / count, 1.0 / 3, 0.004);
  EXPECT_NEAR(normal_sum / count, 0, 0.01);
  EXPECT_NEAR(normal_squares / count, 1, 0.02);
}

TEST(RandomStream, seedsAndPurposesGiveStreamsOfTheirOwn) {
  std::set<std::uint64_t> first;
  for (std::uint64_t seed = 0; seed < 100; ++seed)
    for (std::uint64_t purpose = 0; purpose < 10; ++purpose) first.insert(RandomStream(seed, purpose).bits());
  EXPECT_EQ(first.size(), 1000U);
  EXPECT_EQ(RandomStream(5, 3).bits(), RandomStream(5, 3).bits());
  RandomStream random(1);
  for (int i = 0; i < 1000; ++i) EXPECT_LE(std::abs(random.normal(0, 1, 1.5)), 1.5);
}

TEST(JunctionHeight, isAQuadraticInsideTheNeckAndGoesOnFlatOutside) {
  JunctionHeight junction;
  junction.coefficients = {1, 0.5, -0.25, 0.125, 0, -0.5};
  junction.half_width = {2, 4};
  EXPECT_DOUBLE_EQ(junction(0, 0), 1);
  EXPECT_DOUBLE_EQ(junction(1, 2), 1 + 0.5 - 0.5 + 0.125 - 2);
  EXPECT_DOUBLE_EQ(junction(2, 0), junction(20, 0));
  EXPECT_DOUBLE_EQ(junction(0, -4), junction(0, -5));
}

TEST(CrownCrop, planeThroughABall) {
  const SyntheticTooth tooth = ball(5);
  for (const double height : {-2.3, 0.07, 3.1}) {
    GumLine line;
    line.offset_mm = height;
    const auto crown = crop_crown(tooth, line);
    ASSERT_TRUE(crown);
    expect_disc(*crown);
    // The area vectors of a cap sum to the disc it stands on; its area is 2 pi r h.
    const Eigen::Vector3d sum = area_vector(*crown);
    const double disc = std::numbers::pi * (25 - height * height);
    EXPECT_NEAR(sum.z(), disc, 0.005 * disc);
    EXPECT_LT(sum.head<2>().norm(), 1e-9);
    const double area = 2 * std::numbers::pi * 5 * (5 - height);
    EXPECT_NEAR(surface_area(*crown), area, 0.005 * area);
    for (const Point& p : crown->vertices) EXPECT_GT(p.z(), height - 2e-3);
  }
}

TEST(CrownCrop, keepsVerticesAboveTheLineToTheBit) {
  const SyntheticTooth tooth = ball(5);
  GumLine line;
  line.offset_mm = 0.5;
  line.wave_mm = {0.3, 0.2, 0.1, 0.1, 0.05};
  const auto crown = crop_crown(tooth, line);
  ASSERT_TRUE(crown);
  expect_disc(*crown);
  const auto less = [](const Point& a, const Point& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
  };
  std::set<Point, decltype(less)> kept(crown->vertices.begin(), crown->vertices.end(), less);
  for (const Point& p : tooth.mesh.vertices)
    EXPECT_EQ(kept.contains(p), p.z() - line.height(tooth.junction, p.x(), p.y()) >= 0);
}

TEST(CrownCrop, nothingAboveTheLineIsNoCrown) {
  GumLine line;
  line.offset_mm = 6;
  EXPECT_FALSE(crop_crown(ball(5), line));
  line.offset_mm = -6;  // the whole ball: no border
  EXPECT_FALSE(crop_crown(ball(5), line));
}

TEST(GumLine, cropsOfThePaperLieAcrossTheLongAxis) {
  SyntheticTooth tooth = ball(5);
  const Eigen::Matrix3d lean =
      Eigen::AngleAxisd(12 * std::numbers::pi / 180, Eigen::Vector3d(1, 2, 0).normalized()).toRotationMatrix();
  for (Point& p : tooth.mesh.vertices) p = lean * Point(p.x(), p.y(), 2.2 * p.z());
  tooth.crown_height = tooth.root_length = 11;
  const Eigen::Vector3d axis = lean.col(2);
  double mean = 0;
  constexpr int draws = 40;
  for (std::uint64_t seed = 0; seed < draws; ++seed) {
    RandomStream random(seed);
    const TriangleMesh crown = draw_cropped_crown(tooth, 1, 0, random).mesh;
    mean += std::acos(std::min(1.0, area_vector(crown).normalized().dot(axis))) / draws;
  }
  EXPECT_LT(mean * 180 / std::numbers::pi, 4.5)
      << "tilt of 2.5 degrees along x and y, and waves; the lean itself is 12";
}

TEST(GumLine, notchesAreAtTheContacts) {
  GumLine line;
  line.gap_mm = {1.5, 0.5};
  JunctionHeight flat;
  EXPECT_NEAR(line.height(flat, 3, 0), 0.5, 1e-6);
  EXPECT_NEAR(line.height(flat, -3, 0), 1.5, 1e-6);
  EXPECT_LT(line.height(flat, 0, 3), 1e-4);
}

TEST(ScannerMesh, isADiscOnTheSameSurface) {
  GumLine line;
  line.offset_mm = 1;
  const auto crown = crop_crown(ball(5), line);
  ASSERT_TRUE(crown);
  const TriangleMesh scan = scanner_mesh(*crown, 0.5, 0.01, 3);
  expect_disc(scan);
  EXPECT_NEAR(mean_edge_length(scan), 0.5, 0.1);
  for (const Point& p : scan.vertices) EXPECT_NEAR(p.norm(), 5, 0.06);
  EXPECT_THROW(scanner_mesh(*crown, 5, 0.01, 3), UsageError);
  EXPECT_THROW(scanner_mesh(*crown, 0.5, -1, 3), UsageError);
}

TEST(TrimClean, CutsALittleAboveTheJunction) {
  const SyntheticTooth tooth = ball(5);
  RandomStream random(3, 200);
  const CroppedCrown crown = trim_clean(tooth, random);
  expect_disc(crown.mesh);
  EXPECT_EQ(crown.line.offset_mm, 0.4);
  double least = 5;
  for (const Point& p : crown.mesh.vertices) least = std::min(least, p.z());
  EXPECT_GT(least, -0.4);
  EXPECT_LT(least, 1.2);
}

TEST(SyntheticFile, OfTheRightSideIsMirroredAndFacesOutward) {
  const SyntheticTooth tooth = ball(5);
  const MeshFile left = synthetic_tooth_file(tooth, {}, false), right = synthetic_tooth_file(tooth, {}, true);
  EXPECT_GT(volume(left.mesh), 0);
  EXPECT_NEAR(volume(right.mesh), volume(left.mesh), 1e-9);
  EXPECT_EQ(right.mesh.vertices[40].x(), -left.mesh.vertices[40].x());
  const std::vector<double>& source = left.vertex_attributes.at(source_attribute).values;
  EXPECT_EQ(source.front(), static_cast<double>(VertexSource::scan));
  EXPECT_EQ(source.back(), static_cast<double>(VertexSource::predicted));
  EXPECT_EQ(right.vertex_attributes.at(source_attribute).values, source);
}

TEST(SyntheticFile, OfACrownIsAsItWasCutOrAsAScannerSeesIt) {
  const SyntheticTooth tooth = ball(5);
  RandomStream random(3, 200);
  const CroppedCrown crown = trim_clean(tooth, random);
  const MeshFile cut = synthetic_crown_file(tooth, crown, true, {});
  EXPECT_EQ(cut.mesh.triangles, on_other_side(crown.mesh).triangles);
  EXPECT_NEAR(cut.mesh.vertices[7].x(), -crown.mesh.vertices[7].x(), 1e-6);
  EXPECT_EQ(cut.comments, synthetic_tooth_file(tooth, crown.line, true).comments);
  const MeshFile scanned = synthetic_crown_file(tooth, crown, false, {0.5, 0, 7});
  EXPECT_EQ(scanned.mesh.vertices, scanner_mesh(crown.mesh, 0.5, 0, 7).vertices);
}

}  // namespace
}  // namespace rhizodont
