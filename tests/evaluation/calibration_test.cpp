// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluation/calibration.hpp"

#include <gtest/gtest.h>

#include <random>

#include "evaluation/evaluation_plot.hpp"
#include "rhizodont/error.hpp"

namespace rhizodont {
namespace {

/// Teeth whose errors are normal with a deviation that the predictor knows up to a factor of 3; lengths are 0.4 mm
/// short on average.
Evaluation made_up(int teeth, unsigned seed, const UncertaintyScales& scales) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  Evaluation evaluation;
  evaluation.predictors = {"made up"};
  for (int i = 0; i < teeth; ++i) {
    const double deviation = 0.5 + 0.1 * (i % 10), said = deviation / 3;
    RootFigures figures;
    figures.true_root_length_mm = 13 + normal(random);
    figures.root_length_error_mm = deviation * normal(random) - 0.4;
    UncertaintyFigures u;
    u.apex_expected_distance_mm = said;
    u.length_mm = figures.true_root_length_mm + figures.root_length_error_mm;
    u.apex_distance_mm = std::abs(deviation * normal(random));
    u.uncertainty_mm = scales.surface * said;
    u.surface_distance_mm = 0.5 * deviation;
    u.interval = {u.length_mm + scales.length_low * said, u.length_mm + scales.length_high * said, scales.apex * said};
    evaluation.cases.push_back({{i % 2 == 0 ? 11 : 36, "", "", ""}, {{figures, u, "", 0}}});
  }
  return evaluation;
}

TEST(Calibration, IntervalsHoldFourFifthsOfOtherTeeth) {
  const UncertaintyScales scales = calibrate(made_up(2000, 1, {0, 0, 0, 1}), 0, {0, 0, 0, 1});
  const Coverage c = coverage(made_up(2000, 2, scales), 0);
  EXPECT_EQ(c.teeth, 2000);
  EXPECT_NEAR(c.length, 0.8, 0.03);
  EXPECT_NEAR(c.apex, 0.8, 0.03);
  EXPECT_NEAR(scales.surface, 1.5, 1e-9);
  // the truth is longer than predicted: the interval lies higher than the prediction
  EXPECT_GT(scales.length_low + scales.length_high, 0.5);
}

TEST(Calibration, DoesNotDependOnTheScalesBefore) {
  const UncertaintyScales used{-2, 3, 4, 0.25};
  const UncertaintyScales one = calibrate(made_up(100, 3, {0, 0, 0, 1}), 0, {0, 0, 0, 1});
  const UncertaintyScales other = calibrate(made_up(100, 3, used), 0, used);
  EXPECT_EQ(one.length_low, other.length_low);
  EXPECT_EQ(one.apex, other.apex);
  EXPECT_NEAR(one.surface, other.surface, 1e-12);
}

/// Roots of a type whose errors have another deviation and bias than those of the next.
std::vector<RootOutcome> roots_of(int fdi, double deviation, double bias, int count, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::vector<RootOutcome> roots;
  for (int i = 0; i < count; ++i) {
    const double truth = 13 + normal(random);
    roots.push_back({fdi, truth + bias + deviation * normal(random), truth, std::abs(deviation * normal(random)), 1});
  }
  return roots;
}

TEST(Calibration, HoldsFourFifthsOfEachType) {
  const auto of_two = [](unsigned seed) {
    std::vector<RootOutcome> roots = roots_of(11, 0.5, 0.3, 2000, seed);
    const std::vector<RootOutcome> others = roots_of(36, 2, -0.5, 2000, seed + 1);
    roots.insert(roots.end(), others.begin(), others.end());
    return roots;
  };
  const std::vector<RootOutcome> learned = of_two(1), fresh = of_two(3);
  std::map<std::string, std::string> together, by_type;
  note_uncertainty_scales(interval_scales(learned, 1), together);
  note_uncertainty_scales(interval_scales(learned, 1), by_type, interval_scales_by_type(learned, 1));
  for (const int fdi : {11, 36}) {
    std::vector<RootOutcome> of_type;
    for (const RootOutcome& root : fresh)
      if (root.fdi == fdi) of_type.push_back(root);
    EXPECT_GT(std::abs(coverage(of_type, together).length - 0.8), 0.05) << "one scale cannot suit both";
    const Coverage held = coverage(of_type, by_type);
    EXPECT_EQ(held.teeth, 2000);
    EXPECT_NEAR(held.length, 0.8, 0.03) << fdi;
    EXPECT_NEAR(held.apex, 0.8, 0.03) << fdi;
  }
  EXPECT_TRUE(interval_scales_by_type(roots_of(11, 1, 0, 49, 5), 1).empty()) << "too few for scales of their own";
}

TEST(Calibration, NeedsTeethThatSayHowSureTheyAre) {
  EXPECT_THROW(calibrate(made_up(19, 4, {0, 0, 0, 1}), 0, {0, 0, 0, 1}), UsageError);
  Evaluation silent = made_up(50, 4, {0, 0, 0, 1});
  for (EvaluatedCase& evaluated : silent.cases) evaluated.outcomes[0].uncertainty.reset();
  EXPECT_THROW(calibrate(silent, 0, {0, 0, 0, 1}), UsageError);
  EXPECT_EQ(coverage(silent, 0).teeth, 0);
}

TEST(Calibration, GoesIntoTheWeightsMetadata) {
  const UncertaintyScales used{-2, 3, 4, 0.25};
  const Evaluation teeth = made_up(100, 3, used);
  std::map<std::string, std::string> metadata;
  note_uncertainty_scales(used, metadata);
  const UncertaintyScales scales = calibrate_weights(teeth, 0, metadata);
  EXPECT_EQ(scales.surface, calibrate(teeth, 0, used).surface);
  EXPECT_EQ(metadata.at("uncertainty.teeth"), "100");
  const auto noted = uncertainty_scales(metadata);
  ASSERT_TRUE(noted);
  EXPECT_NEAR(noted->length_high, scales.length_high, 1e-4);
}

TEST(Evaluation, SplitsByTypeInOrder) {
  Evaluation evaluation = made_up(10, 5, {0, 0, 0, 1});
  evaluation.cases[0].files.fdi = 46;
  const auto parts = split_by_type(evaluation);
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_EQ(parts[0].first, "upper 1");
  EXPECT_EQ(parts[1].first, "lower 6");
  EXPECT_EQ(parts[0].second.cases.size(), 4U);
  EXPECT_EQ(parts[1].second.cases.size(), 6U);
}

TEST(RootLengthPlot, DrawsEachToothOnce) {
  const std::string svg = root_length_plot(made_up(10, 6, {-1, 1, 1, 1}));
  const auto count = [&](const std::string& what) {
    int found = 0;
    for (std::size_t at = svg.find(what); at != std::string::npos; at = svg.find(what, at + 1)) ++found;
    return found;
  };
  EXPECT_EQ(count("<circle"), 10);
  EXPECT_EQ(count("opacity"), 10);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_THROW(root_length_plot({}), NoResultError);
}

}  // namespace
}  // namespace rhizodont
