// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// What is done where the plain way leads nowhere, each once, and that the record says so. Crowns that are none come
// this far with a models' folder that has nothing to judge crowns by.

#include "common/temporary_folder.hpp"
#include "mesh/geometry.hpp"
#include "pipeline/product_models.hpp"
#include "rhizodont/check.hpp"
#include "rhizodont/complete.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/io.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace rhizodont {
namespace {

using test::source_folder;

const CompletionModels& models_without_likeness() {
  static const CompletionModels loaded = [] {
    const test::TemporaryFolder folder;
    for (const char* name : {"completion.safetensors", "atlas.safetensors"})
      std::filesystem::copy_file(source_folder / "models" / name, folder.path() / name);
    return CompletionModels::load(folder.path());
  }();
  return loaded;
}

/// Half of an ellipsoid, its base on z = 0, by latitude and longitude; half axes in mm.
TriangleMesh half_ellipsoid(double a, double b, double c) {
  constexpr int around = 24, rings = 8;
  TriangleMesh mesh{{{0, 0, c}}, {}};
  for (int ring = 1; ring <= rings; ++ring)
    for (int i = 0; i < around; ++i) {
      const double polar = ring * std::numbers::pi / (2 * rings), turn = 2 * std::numbers::pi * i / around;
      mesh.vertices.emplace_back(a * std::sin(polar) * std::cos(turn), b * std::sin(polar) * std::sin(turn),
                                 c * std::cos(polar));
    }
  for (int i = 0; i < around; ++i) {
    const int j = (i + 1) % around;
    mesh.triangles.push_back({0, 1 + i, 1 + j});
    for (int ring = 0; ring + 1 < rings; ++ring) {
      const int first = 1 + ring * around;
      mesh.triangles.push_back({first + i, first + around + i, first + j});
      mesh.triangles.push_back({first + j, first + around + i, first + around + j});
    }
  }
  return mesh;
}

/// The tooth, which keeps its promises whatever was done to get it.
CompletedTooth completed(const TriangleMesh& crown, int fdi) {
  CompleteOptions options = test::for_tooth(fdi);
  options.e = 1;
  CompletedTooth tooth = complete_tooth(crown, models_without_likeness(), options);
  CheckOptions exact;
  exact.compare_as_float = false;
  const CheckReport report = check(crown, tooth.mesh, exact);
  EXPECT_TRUE(report.holds()) << (report.failures.empty() ? "" : report.failures.front());
  EXPECT_FALSE(tooth.record.likeness);
  return tooth;
}

/// How many of the warnings begin with these words.
std::ptrdiff_t warned(const CompletionRecord& record, const std::string& words) {
  return std::count_if(record.warnings.begin(), record.warnings.end(),
                       [&](const std::string& warning) { return warning.rfind(words, 0) == 0; });
}

const std::string anew = "The first prediction of the root fell to pieces; the crown was laid anew.";
const std::string mean = "No root could be predicted from this crown; it has that of a mean ";

TEST(Fallbacks, ACrownThatIsWhatItIsSaidToBeNeedsNone) {
  const CompletionRecord record = completed(load_mesh(source_folder / "samples/crown_11.stl").mesh, 11).record;
  EXPECT_EQ(record.root.source, RootSource::network);
  EXPECT_TRUE(record.warnings.empty());
}

TEST(Fallbacks, ARootThatFallsToPiecesIsPredictedFromTheCrownLaidAnew) {
  // An incisor said to be an upper molar.
  const CompletionRecord record = completed(load_mesh(source_folder / "samples/crown_11.stl").mesh, 17).record;
  EXPECT_EQ(record.root.source, RootSource::network_laid_anew);
  EXPECT_EQ(warned(record, anew), 1);
  EXPECT_EQ(warned(record, mean), 0);
}

TEST(Fallbacks, WhereNoneIsPredictedTheMeanToothLendsItsRoot) {
  // Half a ball said to be an incisor.
  const CompletedTooth tooth = completed(half_ellipsoid(4, 4, 4), 11);
  EXPECT_EQ(tooth.record.root.source, RootSource::mean_tooth);
  EXPECT_EQ(warned(tooth.record, mean + "11"), 1);
  EXPECT_EQ(warned(tooth.record, anew), 0);
  EXPECT_GE(tooth.record.root.apex_expected_distance_mm, 3) << "nothing is known of this root";
}

TEST(Fallbacks, WhereNoRootFitsAtAllThereIsNoResult) {
  try {
    completed(half_ellipsoid(2, 2, 9), 36);  // a finger
    FAIL() << "was completed";
  } catch (const NoResultError& error) {
    EXPECT_EQ(std::string(error.what()).rfind("No root can be predicted from this crown", 0), 0U) << error.what();
  }
}

TEST(Fallbacks, ModelsWithoutANetworkForSkirtsRefuseToLookForOne) {
  CompleteOptions options = test::for_tooth(11);
  options.skirt = 0.5;
  EXPECT_THROW(complete_tooth(half_ellipsoid(4, 4, 4), models_without_likeness(), options), UsageError);
}

}  // namespace
}  // namespace rhizodont
