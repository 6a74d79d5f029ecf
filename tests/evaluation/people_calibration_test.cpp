// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluation/people_calibration.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "completion/root_length_correction.hpp"
#include "evaluation/held_out_people.hpp"
#include "families/one_template.hpp"
#include "networks/safetensors.hpp"
#include "pipeline/models.hpp"
#include "rhizodont/error.hpp"

namespace rhizodont::test {
namespace {

class PeopleCalibrationOfOneType : public OneTemplate {
 protected:
  /// The shipped models, with other metadata.
  CompletionModels models_with(const std::map<std::string, std::string>& metadata) const {
    const std::filesystem::path models = folder.path() / "models";
    std::filesystem::create_directory(models);
    const auto copied = std::filesystem::copy_options::overwrite_existing;
    std::filesystem::copy_file(default_models_folder() / "atlas.safetensors", models / "atlas.safetensors", copied);
    TensorFile weights = read_safetensors(default_models_folder() / "completion.safetensors");
    weights.metadata = metadata;
    write_safetensors(models / "completion.safetensors", weights);
    return CompletionModels::load(models);
  }

  static std::map<std::string, std::string> shipped() {
    return content_of(CompletionModels::load(default_models_folder()))->network.metadata();
  }
};

TEST_F(PeopleCalibrationOfOneType, CorrectsLengthsWhateverTheWeightsSaidBefore) {
  constexpr int fdi = 36;
  const ToothFamilies families = load();
  PeopleCalibrationOptions options;
  options.people = 20;
  options.completed = 1;
  options.types = {molar};
  options.largest_bias_mm = 0;
  std::map<std::string, std::string> metadata = shipped();
  note_root_length_corrections({}, metadata);
  const PeopleCalibration found = calibrate_on_people(families, models_with(metadata), options);
  EXPECT_EQ(found.predicted, 20U);
  EXPECT_EQ(found.completed, 1U);
  ASSERT_TRUE(found.types.contains(fdi) && found.correction_mm.contains(fdi));
  EXPECT_EQ(found.correction_mm.at(fdi), -found.bias_mm.at(fdi));
  EXPECT_GT(found.types.at(fdi).apex, 0);
  EXPECT_GT(found.all.surface, 0);

  note_calibration(found, metadata);
  const CompletionModels corrected = models_with(metadata);
  double off = 0;
  std::vector<RootOutcome> roots;
  for (std::uint64_t number = 0; number < options.people; ++number) {
    const PersonDraw person = held_out_person(HeldOutPeople::for_calibration, number);
    const SyntheticTooth tooth = held_out_tooth(families, person, molar);
    TriangleMesh crown = held_out_crown(tooth, person);
    const PredictedRoot root = predicted_root(crown, tooth.mesh, fdi, corrected);
    roots.push_back(lengthened(root, found.surface_longer_mm.at(fdi)));
    off += roots.back().length_mm - roots.back().true_length_mm;
  }
  EXPECT_NEAR(off / static_cast<double>(roots.size()), 0, 0.05)
      << "the first person's tooth was completed before, and here is not";
  const Coverage held = coverage(roots, content_of(corrected)->network.metadata());
  EXPECT_GE(held.length, 0.75);
  EXPECT_GE(held.apex, 0.75);

  const PeopleCalibration again = calibrate_on_people(families, corrected, options);
  // but for the one completed tooth's surface, whose lattice lies elsewhere on a root of another length
  EXPECT_NEAR(again.correction_mm.at(fdi), found.correction_mm.at(fdi), 0.05);
  EXPECT_NEAR(again.types.at(fdi).length_low, found.types.at(fdi).length_low, 0.03);
  EXPECT_NEAR(again.types.at(fdi).apex, found.types.at(fdi).apex, 0.03);
  EXPECT_NEAR(again.all.surface, found.all.surface, 0.1 * found.all.surface);

  const double bias = found.bias_mm.at(fdi);
  options.largest_bias_mm = std::abs(bias) / 2;
  EXPECT_NEAR(calibrate_on_people(families, corrected, options).correction_mm.at(fdi), -bias / 2, 0.05)
      << "to where it may be, and no further";
  options.largest_bias_mm = std::abs(bias) + 1;
  EXPECT_TRUE(calibrate_on_people(families, corrected, options).correction_mm.empty()) << "small enough as it is";
  EXPECT_NE(calibration_text(found).find("| 36 |"), std::string::npos);
}

TEST_F(PeopleCalibrationOfOneType, RefusesOptionsOutOfRange) {
  const ToothFamilies families = load();
  const CompletionModels models = CompletionModels::load(default_models_folder());
  PeopleCalibrationOptions few, more, odd;
  few.people = 19;
  more.completed = more.people + 1;
  odd.types = {16};
  for (const PeopleCalibrationOptions& options : {few, more, odd})
    EXPECT_THROW(calibrate_on_people(families, models, options), UsageError);
}

TEST(HeldOutPeopleTest, MedianOfAnEvenNumberLiesBetweenTheMiddleOnes) {
  EXPECT_EQ(median({5}), 5);
  EXPECT_EQ(median({9, 1, 2}), 2);
  EXPECT_EQ(median({9, 1, 4, 2}), 3);
}

TEST(HeldOutPeopleTest, SurfacesOfTypesWithFewTeethAreAsMuchLongerAsAll) {
  const auto longer = surface_longer_by_type({{11, {1, 5, 2}}, {36, {-3, -1}}, {37, {}}});
  EXPECT_EQ(longer, (std::map<int, double>{{11, 2}, {36, 1}, {37, 1}}));
  EXPECT_TRUE(surface_longer_by_type({{11, {}}}).empty());
}

TEST(HeldOutPeopleTest, SurfacesAreComparedWithPointsOfTheNetworksFirstRootsAlone) {
  PredictedRoot points;
  points.outcome.length_mm = 12;
  CaseOutcome completed;
  EXPECT_FALSE(surface_longer(completed, points)) << "refused";
  completed.figures.emplace();
  EXPECT_FALSE(surface_longer(completed, points)) << "does not say how sure it is";
  completed.uncertainty.emplace().length_mm = 12.5;
  EXPECT_EQ(surface_longer(completed, points), 0.5);
  completed.uncertainty->source = RootSource::mean_tooth;
  EXPECT_FALSE(surface_longer(completed, points));
  completed.uncertainty->source = RootSource::network;
  points.source = RootSource::network_laid_anew;
  EXPECT_FALSE(surface_longer(completed, points));
}

TEST(HeldOutPeopleTest, AreOthersForFiguresThanForCalibration) {
  EXPECT_NE(held_out_person(HeldOutPeople::for_figures, 0).seed,
            held_out_person(HeldOutPeople::for_calibration, 0).seed);
  EXPECT_EQ(held_out_person(HeldOutPeople::for_figures, 5).size, held_out_person(HeldOutPeople::for_figures, 5).size);
}

}  // namespace
}  // namespace rhizodont::test
