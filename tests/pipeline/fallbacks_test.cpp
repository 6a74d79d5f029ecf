// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// What is done where the plain way leads nowhere, each once, and that the record says so. Crowns that are none come
// this far with a models' folder that has nothing to judge crowns by.

#include "base/float_bits.hpp"
#include "common/temporary_folder.hpp"
#include "guiding/guiding_cloud.hpp"
#include "guiding/guiding_surface.hpp"
#include "mesh/geometry.hpp"
#include "pipeline/prepared_tooth.hpp"
#include "pipeline/product_models.hpp"
#include "rhizodont/check.hpp"
#include "rhizodont/complete.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/io.hpp"
#include "rhizodont/tooth_file.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

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
  // A premolar said to be an upper molar.
  const CompletionRecord record = completed(load_mesh(source_folder / "samples/crown_34.ply").mesh, 17).record;
  EXPECT_EQ(record.root.source, RootSource::network_laid_anew);
  EXPECT_EQ(warned(record, anew), 1);
  EXPECT_EQ(warned(record, mean), 0);
}

TEST(Fallbacks, WhereNoneIsPredictedTheMeanToothLendsItsRoot) {
  // Half a ball said to be an upper molar.
  const CompletedTooth tooth = completed(half_ellipsoid(4.5, 4.5, 4.5), 16);
  EXPECT_EQ(tooth.record.root.source, RootSource::mean_tooth);
  EXPECT_EQ(warned(tooth.record, mean + "16"), 1);
  EXPECT_EQ(warned(tooth.record, anew), 0);
  EXPECT_GE(tooth.record.root.apex_expected_distance_mm, 3) << "nothing is known of this root";
}

TEST(Fallbacks, WhereNoRootFitsAtAllThereIsNoResult) {
  try {
    completed(half_ellipsoid(2, 2, 12), 36);  // a finger
    FAIL() << "was completed";
  } catch (const NoResultError& error) {
    EXPECT_EQ(std::string(error.what()).rfind("No root can be predicted from this crown", 0), 0U) << error.what();
  }
}

TEST(Fallbacks, WhereFloatsLieTooFarApartNewVerticesHaveDoublePrecision) {
  // A kilometre out on each axis floats are 0.06 to 0.12 mm apart: the crown may be as coarse, the root cuts itself.
  TriangleMesh crown = load_mesh(source_folder / "samples/crown_34.ply").mesh;
  for (Point& p : crown.vertices) p = nearest_float(p + Point::Constant(1048576));
  ASSERT_TRUE(coordinates_fit_float(crown));
  const CompletedTooth tooth = complete_tooth(crown, test::models(), test::for_tooth(34));
  EXPECT_EQ(warned(tooth.record, "The crown lies so far from the origin that single precision is too coarse"), 1);
  EXPECT_FALSE(coordinates_fit_float(tooth.mesh));
  CheckOptions exact;
  exact.compare_as_float = false;
  EXPECT_TRUE(check(crown, tooth.mesh, exact).holds());
  EXPECT_THROW(require_format_holds(tooth, "tooth.stl"), NoResultError);
  EXPECT_NO_THROW(require_format_holds(tooth, "tooth.ply"));
}

TEST(Fallbacks, WhereTheSurfaceCannotBeDrawnOntoTheCrownTheJointIsWarnedOf) {
  CompleteOptions options = test::for_tooth(34);
  options.e = 1;
  const auto prepared =
      prepared_content(load_mesh(source_folder / "samples/crown_34.ply").mesh, models_without_likeness(), options);
  PreparedTooth::Content& content = *prepared;
  const CompletionRecord fitted = finished_tooth(content, {}, {}, {}).record;
  ASSERT_FALSE(content.surface.fit.undone);
  // What `fit_to_crown` leaves where it is undone: the surface as it came.
  const GuidingCloud cloud = assemble_guiding_cloud(content.crown, content.predicted.cloud);
  GuidingSurfaceOptions as_it_comes;
  as_it_comes.isosurface.e = options.e;
  const std::span<const Point> seeds(cloud.samples.points.data(), static_cast<std::size_t>(cloud.crown_samples));
  content.surface.mesh = guiding_surface(cloud.samples, cloud.confidence, seeds, as_it_comes).surface.mesh;
  content.surface.fit = {};
  content.surface.fit.undone = true;
  const CompletionRecord record = finished_tooth(content, {}, {}, {}).record;
  const std::string words = "Drawn onto the crown the guiding surface would have met itself";
  EXPECT_EQ(warned(fitted, words), 0);
  EXPECT_EQ(warned(record, words), 1);
  EXPECT_GT(record.joining.guiding_distance_max_mm, fitted.joining.guiding_distance_max_mm);
  EXPECT_TRUE(record.promises.holds());
}

TEST(Fallbacks, ModelsWithoutANetworkForSkirtsRefuseToLookForOne) {
  CompleteOptions options = test::for_tooth(11);
  options.skirt = 0.5;
  EXPECT_THROW(complete_tooth(half_ellipsoid(4, 4, 4), models_without_likeness(), options), UsageError);
}

}  // namespace
}  // namespace rhizodont
