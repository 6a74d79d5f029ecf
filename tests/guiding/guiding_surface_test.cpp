// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "guiding/guiding_surface.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "mesh/closest_point.hpp"
#include "mesh/diagnosis.hpp"
#include "mesh/sampling.hpp"
#include "poisson/shapes.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/io.hpp"

namespace rhizodont {
namespace {

const std::filesystem::path templates = std::filesystem::path(RHIZODONT_SOURCE_DIR) / "../shared/data/templates";

struct Distances {
  double mean = 0.0, most = 0.0;
};

Distances distances_to(const TriangleMesh& surface, const std::vector<Point>& points) {
  const ClosestPointIndex index(surface);
  Distances distances;
  for (const Point& p : points) {
    const double distance = index.closest(p).distance;
    distances.mean += distance / static_cast<double>(points.size());
    distances.most = std::max(distances.most, distance);
  }
  return distances;
}

class GuidingSurfaceOfTooth : public testing::TestWithParam<int> {};

TEST_P(GuidingSurfaceOfTooth, IsASolidAsNearToTheSamplesAsThePapersTable) {
  const auto path = templates / ("tooth_" + std::to_string(GetParam()) + ".ply");
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no template teeth at " << templates;
  const SurfaceSamples on_tooth = sample_surface(load_mesh(path).mesh, 20000, 1);
  const OrientedPoints samples{on_tooth.points, on_tooth.normals};
  const GuidingSurface guide = guiding_surface(samples, {}, {});
  const Diagnosis diagnosis = diagnose(guide.surface.mesh);
  EXPECT_TRUE(diagnosis.is_closed_solid());
  EXPECT_EQ(guide.surface.euler_number, 2);
  const Distances distances = distances_to(guide.surface.mesh, samples.points);
  EXPECT_LT(distances.mean, 1.41e-2);  // table 1 at e = 0.5
  EXPECT_LT(distances.most, 0.16);
}

INSTANTIATE_TEST_SUITE_P(Templates, GuidingSurfaceOfTooth, testing::Values(21, 31, 36));

/// Roots that all but touch: at e = 0.5 the plain tiling sees tunnels between them.
TEST(GuidingSurface, HasNoTunnelsBetweenRootsThatTouch) {
  for (const int fdi : {28, 38}) {
    const auto path = templates / ("tooth_" + std::to_string(fdi) + ".ply");
    if (!std::filesystem::exists(path)) GTEST_SKIP() << "no template teeth at " << templates;
    const SurfaceSamples on_tooth = sample_surface(load_mesh(path).mesh, 20000, 1);
    const GuidingSurface guide = guiding_surface({on_tooth.points, on_tooth.normals}, {}, {});
    EXPECT_TRUE(diagnose(guide.surface.mesh).is_closed_solid());
    EXPECT_GT(guide.surface.relabelled_vertices, 0U);
    EXPECT_EQ(guide.samples_per_cell, IndicatorOptions().samples_per_cell);
  }
}

TEST(GuidingSurface, TakesAllSamplesAsSeedsIfThereAreNone) {
  const OrientedPoints samples = shapes::sphere(2000, 2.0);
  const GuidingSurface guide = guiding_surface(samples, {}, {});
  EXPECT_EQ(guide.surface.euler_number, 2);
  EXPECT_EQ(guide.surface.relabelled_vertices, 0U);
  const Distances distances = distances_to(guide.surface.mesh, samples.points);
  EXPECT_LT(distances.most, 0.05);
}

TEST(GuidingSurface, SaysThatATorusIsNotATooth) {
  std::mt19937 random(1);
  const OrientedPoints samples = shapes::torus(3000, 4.5, 1.9, random);
  GuidingSurfaceOptions options;
  options.smearings = 1;
  EXPECT_THROW(guiding_surface(samples, {}, {}, options), NoResultError);
}

TEST(GuidingSurface, KeepsRootsApartAndTheirLength) {
  std::mt19937 random(2);
  const OrientedPoints samples = shapes::capsules(6000, shapes::two_rooted(), random);
  const GuidingSurface guide = guiding_surface(samples, {}, {});
  double lowest = 0.0;
  for (const Point& p : guide.surface.mesh.vertices) lowest = std::min(lowest, p.z());
  EXPECT_NEAR(lowest, -13.5, 0.05);
  EXPECT_LT(guide.indicator.value(Point(0.0, 0.0, -6.0)), 0.2);
}

}  // namespace
}  // namespace rhizodont
