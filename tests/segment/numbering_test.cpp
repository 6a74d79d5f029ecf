// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "segment/numbering.hpp"

#include "rhizodont/error.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

namespace rhizodont {
namespace {

const ArchModel& mean_arch() {
  static const ArchModel model =
      load_arch_model(std::filesystem::path(RHIZODONT_SOURCE_DIR) / "models" / "arch.safetensors");
  return model;
}

/// A tooth where the model has it, with what a network would say of it: mostly right, neighbours less likely.
ToothInstance tooth(int fdi, double sure = 0.7) {
  const bool upper = fdi < 30;
  const Point& p = mean_arch().teeth.at(fdi).place;
  ToothInstance instance;
  instance.middle = {upper ? p.x() : -p.x(), p.z(), upper ? -p.y() : p.y()};
  instance.support = 50;
  const int place = place_of_fdi(fdi);
  instance.places.fill(0.02 / arch_place_count);
  instance.places[static_cast<std::size_t>(place)] += sure;
  for (const int beside : {place - 1, place + 1})
    if (beside >= 0 && beside < arch_place_count)
      instance.places[static_cast<std::size_t>(beside)] += (0.98 - sure) / 2;
  return instance;
}

std::vector<ToothInstance> teeth(const std::vector<int>& numbers, double sure = 0.7) {
  std::vector<ToothInstance> all;
  for (const int fdi : numbers) all.push_back(tooth(fdi, sure));
  return all;
}

std::vector<int> numbers_of(const ArchNumbers& numbers) {
  std::vector<int> all;
  for (const ToothNumber& n : numbers.teeth) all.push_back(n.fdi.value_or(0));
  return all;
}

TEST(Numbering, PlacesAndNumbersAreInverse) {
  for (const Jaw jaw : {Jaw::lower, Jaw::upper})
    for (int place = 0; place < arch_place_count; ++place) EXPECT_EQ(place_of_fdi(fdi_of_place(place, jaw)), place);
  EXPECT_EQ(fdi_of_place(0, Jaw::upper), 18);
  EXPECT_EQ(fdi_of_place(8, Jaw::upper), 21);
  EXPECT_EQ(fdi_of_place(0, Jaw::lower), 38);  // the patient's left is at -x in a lower jaw with its front at +y
  EXPECT_EQ(fdi_of_place(15, Jaw::lower), 48);
}

TEST(Numbering, ReadsWholeArchesInAnyOrder) {
  const std::vector<int> upper{21, 17, 12, 11, 16, 15, 14, 13, 27, 26, 25, 24, 23, 22};
  EXPECT_EQ(numbers_of(number_teeth(teeth(upper), Jaw::upper, mean_arch())), upper);
  const std::vector<int> lower{37, 36, 35, 34, 33, 32, 31, 41, 42, 43, 44, 45, 46, 47};
  const ArchNumbers read = number_teeth(teeth(lower), Jaw::lower, mean_arch());
  EXPECT_EQ(numbers_of(read), lower);
  for (const ToothNumber& n : read.teeth) {
    EXPECT_GT(n.probability, 0.9);
    EXPECT_LE(n.probability + n.second_probability, 1 + 1e-9);
  }
}

TEST(Numbering, LeavesOutWhatIsMissing) {
  const std::vector<int> upper{17, 16, 15, 13, 12, 11, 21, 22, 23, 25, 26, 27};
  EXPECT_EQ(numbers_of(number_teeth(teeth(upper), Jaw::upper, mean_arch())), upper);
  const std::vector<int> part{34, 35, 36, 37};
  EXPECT_EQ(numbers_of(number_teeth(teeth(part), Jaw::lower, mean_arch())), part);
}

TEST(Numbering, BelievesTheNetworkWherePremolarsWereTakenOutAndTheGapsClosed) {
  const std::vector<int> upper{17, 16, 15, 13, 12, 11, 21, 22, 23, 25, 26, 27};
  std::vector<ToothInstance> read = teeth(upper);
  for (std::size_t i = 0; i < upper.size(); ++i) {
    const int number = upper[i] % 10;
    if (number < 5) continue;
    // All came forwards until 15 and 25 touched the canines, and the network wavers by one number.
    const int quadrant = upper[i] / 10 * 10;
    const Eigen::Vector3d gap = tooth(quadrant + 5).middle - tooth(quadrant + 3).middle;
    const double contact = (tooth(quadrant + 5).middle - tooth(quadrant + 4).middle).norm();
    read[i].middle -= (1 - contact / gap.norm()) * gap;
    const auto place = static_cast<std::size_t>(place_of_fdi(upper[i])),
               lower = static_cast<std::size_t>(place_of_fdi(upper[i] - 1));
    read[i].places.fill(0.05 / arch_place_count);
    read[i].places[place] += 0.6;
    read[i].places[lower] += 0.35;
  }
  const ArchNumbers numbers = number_teeth(read, Jaw::upper, mean_arch());
  EXPECT_EQ(numbers_of(numbers), upper);
  for (const ToothNumber& n : numbers.teeth) {
    EXPECT_LE(n.probability + n.second_probability, 1 + 1e-9);
    EXPECT_GT(n.probability, n.second_probability);
  }
  // That one of the pair is missing makes the other's absence no less likely; a premolar that is there ends the matter.
  NumberingOptions told;
  told.missing_teeth = {14};
  EXPECT_EQ(numbers_of(number_teeth(read, Jaw::upper, mean_arch(), told)), upper);
  told.missing_teeth = {};
  told.given = {{2, 14}};
  EXPECT_EQ(number_teeth(read, Jaw::upper, mean_arch(), told).teeth[2].fdi, 14);
  NumberingOptions never;
  never.first_premolars_out = never.second_premolars_out = 0;
  EXPECT_GT(numbers.evidence, number_teeth(read, Jaw::upper, mean_arch(), never).evidence);
}

TEST(Numbering, KnowsWisdomTeeth) {
  const std::vector<int> lower{38, 37, 36, 35, 34, 33, 32, 31, 41, 42, 43, 44, 45, 46, 47, 48};
  EXPECT_EQ(numbers_of(number_teeth(teeth(lower, 0.8), Jaw::lower, mean_arch())), lower);
}

TEST(Numbering, GivesNoNumberTwice) {
  std::vector<ToothInstance> read = teeth({17, 16, 15, 14, 13, 12, 11, 21, 22, 23, 24, 25, 26, 27});
  // The network takes the first premolar for the second one too.
  read[3].places = read[2].places;
  const std::vector<int> numbers = numbers_of(number_teeth(read, Jaw::upper, mean_arch()));
  EXPECT_EQ(numbers[2], 15);
  EXPECT_EQ(numbers[3], 14);
}

TEST(Numbering, GivesUpWhatIsNoTooth) {
  std::vector<ToothInstance> read = teeth({16, 15, 14, 13, 12, 11, 21, 22, 23, 24, 25, 26});
  ToothInstance scrap = tooth(14, 0.4);
  scrap.middle.x() += 1.5;
  scrap.support = 8;
  read.push_back(scrap);
  const ArchNumbers numbers = number_teeth(read, Jaw::upper, mean_arch());
  EXPECT_FALSE(numbers.teeth.back().fdi);
  EXPECT_EQ(numbers.teeth[2].fdi, 14);
}

TEST(Numbering, TakesAPersonsWord) {
  const std::vector<ToothInstance> read = teeth({16, 15, 13, 12, 11, 21, 22, 23}, 0.5);
  NumberingOptions options;
  options.given[1] = 14;
  EXPECT_EQ(number_teeth(read, Jaw::upper, mean_arch(), options).teeth[1].fdi, 14);
  options.given.clear();
  options.missing_teeth = {15};
  EXPECT_NE(number_teeth(read, Jaw::upper, mean_arch(), options).teeth[1].fdi, 15);
  options.given[1] = 15;
  EXPECT_THROW(number_teeth(read, Jaw::upper, mean_arch(), options), UsageError);
  options = {};
  options.given = {{0, 36}};
  EXPECT_THROW(number_teeth(read, Jaw::upper, mean_arch(), options), UsageError);
  options.given = {{0, 11}, {4, 16}};  // against their order
  EXPECT_THROW(number_teeth(read, Jaw::upper, mean_arch(), options), UsageError);
}

TEST(Numbering, TheRightJawHasMoreEvidence) {
  // The network tells places from the middle, not jaws: distances alone speak.
  const std::vector<ToothInstance> upper = teeth({17, 16, 15, 14, 13, 12, 11, 21, 22, 23, 24, 25, 26, 27}, 0.5);
  EXPECT_GT(number_teeth(upper, Jaw::upper, mean_arch()).evidence,
            number_teeth(upper, Jaw::lower, mean_arch()).evidence);
  const std::vector<ToothInstance> lower = teeth({37, 36, 35, 34, 33, 32, 31, 41, 42, 43, 44, 45, 46, 47}, 0.5);
  EXPECT_LT(number_teeth(lower, Jaw::upper, mean_arch()).evidence,
            number_teeth(lower, Jaw::lower, mean_arch()).evidence);
}

TEST(Numbering, NothingGivesNothing) { EXPECT_TRUE(number_teeth({}, Jaw::upper, mean_arch()).teeth.empty()); }

}  // namespace
}  // namespace rhizodont
