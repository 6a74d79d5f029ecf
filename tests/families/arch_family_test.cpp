// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "families/arch_family.hpp"

#include "base/random_stream.hpp"
#include "families/marching_cubes.hpp"
#include "mesh/diagnosis.hpp"
#include "mesh/geometry.hpp"
#include "rhizodont/error.hpp"
#include "teeth/clean_labels.hpp"
#include "teeth/fdi.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <set>
#include <vector>

namespace rhizodont {
namespace {

const std::filesystem::path data = std::filesystem::path(RHIZODONT_SOURCE_DIR) / ".." / "shared" / "data";

class GeneratedArches : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(data / "crowns" / "arch_covariances.safetensors"))
      GTEST_SKIP() << "no crown models in " << data;
  }
};

const ArchFamily& family() {
  static const ArchFamily loaded = load_arch_family(data);
  return loaded;
}

/// Coarse and small, to be quick.
ArchDrawOptions quick() {
  ArchDrawOptions options;
  options.grid_mm = 0.6;
  options.triangles = {8000, 12000};
  return options;
}

/// A full arch of a person without anything unusual.
ArchDrawOptions plain() {
  ArchDrawOptions options = quick();
  options.crowding_share = options.spacing_share = options.missing_share = options.wisdom_share = 0;
  options.partial_share = options.milk_share = options.stump_share = options.bracket_share = options.model_share = 0;
  options.defects = 0;
  options.any_pose = false;
  return options;
}

TEST_F(GeneratedArches, DependOnTheSeedAlone) {
  const GeneratedArch first = sample_arch(family(), 5, quick()), again = sample_arch(family(), 5, quick());
  EXPECT_EQ(first.scan.vertices, again.scan.vertices);
  EXPECT_EQ(first.scan.triangles, again.scan.triangles);
  EXPECT_EQ(first.fdi, again.fdi);
  EXPECT_NE(first.scan.vertices, sample_arch(family(), 6, quick()).scan.vertices);
}

TEST_F(GeneratedArches, AreManifoldsWithALabelPerVertex) {
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    SCOPED_TRACE(seed);
    const GeneratedArch arch = sample_arch(family(), seed, quick());
    ASSERT_EQ(arch.fdi.size(), arch.scan.vertices.size());
    EXPECT_LE(arch.scan.triangles.size(), 12100U);
    EXPECT_GE(arch.scan.triangles.size(), 2000U);
    EXPECT_TRUE(diagnose(arch.scan).is_oriented_manifold());
    for (const Point& p : arch.scan.vertices) ASSERT_TRUE(p.allFinite());
    std::map<int, std::size_t> counted;
    for (const int number : arch.fdi)
      if (number != 0) ++counted[number];
    ASSERT_EQ(counted.size(), arch.teeth.size());
    for (const GeneratedTooth& tooth : arch.teeth) {
      EXPECT_TRUE(is_permanent_tooth(tooth.fdi) || is_milk_tooth(tooth.fdi)) << tooth.fdi;
      EXPECT_EQ((tooth.fdi / 10 - 1) % 4 < 2, arch.jaw == Jaw::upper) << tooth.fdi;
      EXPECT_EQ(counted[tooth.fdi], tooth.vertices);
      EXPECT_NEAR(tooth.directions.occlusal.norm(), 1, 1e-9);
      EXPECT_NEAR(tooth.directions.occlusal.dot(tooth.directions.buccal), 0, 1e-9);
    }
    for (const int missing : arch.missing) EXPECT_FALSE(counted.contains(missing)) << missing;
  }
}

TEST_F(GeneratedArches, HaveEachToothInOnePatchAroundItsMiddle) {
  for (std::uint64_t seed = 20; seed < 23; ++seed) {
    SCOPED_TRACE(seed);
    const GeneratedArch arch = sample_arch(family(), seed, quick());
    EXPECT_TRUE(clean_labels(arch.scan, arch.fdi).changes.empty());
    std::map<int, Point> middle;
    for (const GeneratedTooth& tooth : arch.teeth) middle[tooth.fdi] = tooth.middle;
    for (std::size_t v = 0; v < arch.fdi.size(); ++v)
      if (arch.fdi[v] != 0) {
        ASSERT_LT((arch.scan.vertices[v] - middle[arch.fdi[v]]).norm(), 11);
      }
  }
}

TEST_F(GeneratedArches, OfAPlainPersonAreWholeAndStandUpright) {
  for (const Jaw jaw : {Jaw::upper, Jaw::lower}) {
    ArchDrawOptions options = plain();
    options.jaw = jaw;
    const GeneratedArch arch = sample_arch(family(), 3, options);
    ASSERT_EQ(arch.teeth.size(), 14U);
    EXPECT_EQ(arch.teeth.front().fdi, jaw == Jaw::upper ? 17 : 47);
    EXPECT_EQ(arch.teeth.back().fdi, jaw == Jaw::upper ? 27 : 37);
    EXPECT_LT(arch.teeth.front().middle.x(), arch.teeth.back().middle.x() - 30) << "x is to the patient's left";
    EXPECT_GT(arch.teeth[6].middle.z(), arch.teeth.front().middle.z() + 25) << "z is to the front";
    double enamel = 0;
    for (std::size_t t = 0; t < arch.scan.triangles.size(); ++t)
      if (arch.fdi[static_cast<std::size_t>(arch.scan.triangles[t][0])] != 0) enamel += triangle_area(arch.scan, t);
    EXPECT_GT(enamel, 1300);
    EXPECT_LT(enamel, 2800);
    for (const GeneratedTooth& tooth : arch.teeth)
      EXPECT_GT(tooth.directions.occlusal.y() * (jaw == Jaw::upper ? -1 : 1), 0.6) << tooth.fdi;
  }
}

TEST_F(GeneratedArches, OfOneSeedBelongToOnePerson) {
  ArchDrawOptions options = quick();
  options.jaw = Jaw::upper;
  const GeneratedArch upper = sample_arch(family(), 9, options);
  options.jaw = Jaw::lower;
  EXPECT_EQ(upper.size, sample_arch(family(), 9, options).size);
}

TEST_F(GeneratedArches, RefuseOptionsOutOfRange) {
  ArchDrawOptions options;
  options.grid_mm = 0.1;
  EXPECT_THROW(sample_arch(family(), 0, options), UsageError);
  options = {};
  options.missing_share = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(sample_arch(family(), 0, options), UsageError);
  options = {};
  options.triangles = {9000, 8000};
  EXPECT_THROW(sample_arch(family(), 0, options), UsageError);
  options.triangles = {10, 8000};
  EXPECT_THROW(sample_arch(family(), 0, options), UsageError);
}

TEST(ZeroSurfaceOfALattice, IsAClosedManifoldForRandomValues) {
  Lattice lattice;
  lattice.count = {12, 11, 13};
  RandomStream random(4);
  std::vector<float> values(lattice.size(), 1);
  for (int z = 1; z < 12; ++z)
    for (int y = 1; y < 10; ++y)
      for (int x = 1; x < 11; ++x) values[lattice.index(x, y, z)] = static_cast<float>(random.uniform(-1, 1));
  const ZeroSurface surface = zero_surface(lattice, values);
  EXPECT_GT(surface.mesh.triangles.size(), 1000U);
  EXPECT_EQ(surface.between.size(), surface.mesh.vertices.size());
  std::map<std::pair<int, int>, int> directed;
  for (const Triangle& t : surface.mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) ++directed[{t[k], t[(k + 1) % 3]}];
  for (const auto& [edge, times] : directed) {
    EXPECT_EQ(times, 1);
    EXPECT_EQ(directed.count({edge.second, edge.first}), 1U);
  }
  EXPECT_GT(volume(surface.mesh), 0) << "oriented towards growing values";
}

TEST(ZeroSurfaceOfALattice, LiesOnASphere) {
  Lattice lattice;
  lattice.origin = Point(-3, -3, -3);
  lattice.cell = 0.25;
  lattice.count = {25, 25, 25};
  std::vector<float> values;
  for (int z = 0; z < 25; ++z)
    for (int y = 0; y < 25; ++y)
      for (int x = 0; x < 25; ++x) values.push_back(static_cast<float>(lattice.at(x, y, z).norm() - 2.1));
  const ZeroSurface surface = zero_surface(lattice, values);
  EXPECT_TRUE(diagnose(surface.mesh).is_closed_solid());
  for (const Point& p : surface.mesh.vertices) EXPECT_NEAR(p.norm(), 2.1, 0.02);
  EXPECT_NEAR(volume(surface.mesh), 4.0 / 3 * 3.14159265 * 2.1 * 2.1 * 2.1, 0.5);
}

}  // namespace
}  // namespace rhizodont
