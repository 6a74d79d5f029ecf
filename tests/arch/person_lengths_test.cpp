// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "arch/person_lengths.hpp"

#include "base/random_stream.hpp"
#include "rhizodont/error.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <vector>

namespace rhizodont {
namespace {

const std::map<int, LengthExpectation> expected{{11, {13, 1.5}}, {21, {13.2, 1.5}}, {36, {14, 1.2}}, {46, {14.1, 1.2}}};

TEST(PersonLengths, NothingMeasuredChangesNothing) {
  const auto same = given_measured(expected, {});
  for (const auto& [fdi, length] : expected) {
    EXPECT_EQ(same.at(fdi).mm, length.mm);
    EXPECT_EQ(same.at(fdi).deviation_mm, length.deviation_mm);
  }
}

TEST(PersonLengths, OneMeasuredMovesAllAsTheClosedFormSays) {
  const PersonLengthModel model;
  const auto lengths = given_measured(expected, {{36, 16}});
  EXPECT_EQ(lengths.at(36).mm, 16);
  const double variance = 1.2 * 1.2 + model.measurement_mm * model.measurement_mm;
  const auto shift = [&](double correlation, double deviation) { return correlation * deviation * 1.2 / variance * 2; };
  EXPECT_NEAR(lengths.at(46).mm, 14.1 + shift(model.fellow, 1.2), 1e-12);
  EXPECT_NEAR(lengths.at(11).mm, 13 + shift(model.others, 1.5), 1e-12);
  EXPECT_NEAR(lengths.at(46).deviation_mm, std::sqrt(1.44 - std::pow(model.fellow * 1.44, 2) / variance), 1e-12);
}

TEST(PersonLengths, MoreMeasuredNeverMakesUnsure) {
  const auto one = given_measured(expected, {{36, 15}}), two = given_measured(expected, {{36, 15}, {21, 12}});
  for (const int fdi : {11, 46}) {
    EXPECT_LT(one.at(fdi).deviation_mm, expected.at(fdi).deviation_mm);
    EXPECT_LT(two.at(fdi).deviation_mm, one.at(fdi).deviation_mm);
  }
}

TEST(PersonLengths, LowersTheErrorOfPeopleDrawnFromTheModel) {
  // One measured length of 14: the others' mean absolute error, before and after.
  const PersonLengthModel model;
  RandomStream random(7, 1);
  std::map<int, LengthExpectation> teeth;
  for (const int quadrant : {3, 4})
    for (int place = 1; place <= 7; ++place) teeth[10 * quadrant + place] = {13, 1.5};
  double before = 0, after = 0;
  for (int person = 0; person < 2000; ++person) {
    const double common = std::sqrt(model.others) * random.normal(0, 1);
    std::map<int, double> truth;
    for (int place = 1; place <= 7; ++place) {
      const double pair = std::sqrt(model.fellow - model.others) * random.normal(0, 1);
      for (const int quadrant : {3, 4})
        truth[10 * quadrant + place] = 13 + 1.5 * (common + pair + std::sqrt(1 - model.fellow) * random.normal(0, 1));
    }
    const auto lengths = given_measured(teeth, {{36, truth[36] + model.measurement_mm * random.normal(0, 1)}});
    for (const auto& [fdi, mm] : truth) {
      if (fdi == 36) continue;
      before += std::abs(13 - mm);
      after += std::abs(lengths.at(fdi).mm - mm);
    }
  }
  const double lowered = 1 - after / before;
  RecordProperty("error_lowered_by_percent", static_cast<int>(100 * lowered));
  EXPECT_GT(lowered, 0.03);
  EXPECT_LT(lowered, 0.1);
}

TEST(PersonLengths, RefusesWhatCannotBe) {
  EXPECT_THROW(given_measured(expected, {{37, 14}}), UsageError);
  PersonLengthModel model;
  model.others = 0.9;
  EXPECT_THROW(given_measured(expected, {{36, 14}}, model), UsageError);
  model = {};
  model.fellow = 1;
  EXPECT_THROW(given_measured(expected, {{36, 14}}, model), UsageError);
  model = {};
  model.measurement_mm = 0;
  EXPECT_THROW(given_measured(expected, {{36, 14}}, model), UsageError);
}

}  // namespace
}  // namespace rhizodont
