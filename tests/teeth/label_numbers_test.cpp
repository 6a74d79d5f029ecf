// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "teeth/label_numbers.hpp"
#include "teeth/fdi.hpp"
#include "teeth/made_arch.hpp"

namespace rhizodont {
namespace {

using enum LabelNumbers;
using test::expect_input_error, test::made_arch, test::MadeArch, test::renumbered, test::teeth_of;

void expect_decided(const ScanLabels& labels, LabelNumbers numbers, const std::string& words,
                    const std::vector<int>& fdi) {
  EXPECT_EQ(labels.numbers, numbers) << labels.decided;
  EXPECT_NE(labels.decided.find(words), std::string::npos) << labels.decided;
  EXPECT_EQ(labels.fdi, fdi) << labels.decided;
}

TEST(LabelNumbers, WordsAreReadAndWritten) {
  for (const LabelNumbers numbers : {fdi, universal, arch14, arch16})
    EXPECT_EQ(read_label_numbers(label_numbers_name(numbers)), numbers);
  EXPECT_THROW(read_label_numbers("FDI numbers"), UsageError);
}

TEST(LabelNumbers, UniversalGoesAroundBothJaws) {
  EXPECT_EQ(fdi_of_universal(1), 18);
  EXPECT_EQ(fdi_of_universal(8), 11);
  EXPECT_EQ(fdi_of_universal(9), 21);
  EXPECT_EQ(fdi_of_universal(16), 28);
  EXPECT_EQ(fdi_of_universal(17), 38);
  EXPECT_EQ(fdi_of_universal(24), 31);
  EXPECT_EQ(fdi_of_universal(25), 41);
  EXPECT_EQ(fdi_of_universal(32), 48);
  EXPECT_FALSE(fdi_of_universal(33));
  EXPECT_FALSE(fdi_of_universal(0));
  for (int number = 1; number <= 32; ++number)
    EXPECT_EQ(numbered_as({*fdi_of_universal(number), 0}, universal), (std::vector<int>{number, 33}));
}

TEST(LabelNumbers, PlacesAlongTheArch) {
  EXPECT_EQ(fdi_of_arch_place(1, 14, Jaw::upper), 17);
  EXPECT_EQ(fdi_of_arch_place(7, 14, Jaw::upper), 11);
  EXPECT_EQ(fdi_of_arch_place(8, 14, Jaw::upper), 21);
  EXPECT_EQ(fdi_of_arch_place(14, 14, Jaw::upper), 27);
  EXPECT_EQ(fdi_of_arch_place(1, 16, Jaw::lower), 48);
  EXPECT_EQ(fdi_of_arch_place(16, 16, Jaw::lower), 38);
  EXPECT_THROW(fdi_of_arch_place(15, 14, Jaw::upper), UsageError);
  EXPECT_THROW(fdi_of_arch_place(0, 16, Jaw::upper), UsageError);
}

TEST(LabelNumbers, OneNumberAbove33TellsFdi) {
  const MadeArch lower = made_arch(teeth_of(Jaw::lower));
  expect_decided(decide_label_numbers(lower.mesh, lower.fdi), fdi, "34 is among them", lower.fdi);
  const MadeArch upper = made_arch(teeth_of(Jaw::upper), Jaw::upper);
  expect_decided(decide_label_numbers(upper.mesh, upper.fdi), fdi, "all of them are FDI", upper.fdi);
  std::vector<int> milk = renumbered(lower.fdi, [](int n) { return n % 10 == 0 || n % 10 > 5 ? 0 : n + 40; });
  expect_decided(decide_label_numbers(lower.mesh, milk), fdi, "71 is among them", milk);
  const MadeArch canine = made_arch({31, 32, 33});
  expect_decided(decide_label_numbers(canine.mesh, canine.fdi), fdi, "all of them are FDI", canine.fdi);
}

TEST(LabelNumbers, GumOf33TellsUniversal) {
  for (const Jaw jaw : {Jaw::lower, Jaw::upper}) {
    const MadeArch arch = made_arch(teeth_of(jaw, 8), jaw);
    expect_decided(decide_label_numbers(arch.mesh, numbered_as(arch.fdi, universal)), universal, "33 is on", arch.fdi);
  }
  // numbers that are FDI numbers as well
  const MadeArch few = made_arch({24, 25, 26}, Jaw::upper);
  const std::vector<int> raw = numbered_as(few.fdi, universal);
  EXPECT_EQ(*std::min_element(raw.begin(), raw.end()), 12);
  expect_decided(decide_label_numbers(few.mesh, raw), universal, "33 is on", few.fdi);
  // 0 for gum as some write it
  const MadeArch lower = made_arch(teeth_of(Jaw::lower));
  const auto zero = renumbered(numbered_as(lower.fdi, universal), [](int n) { return n == 33 ? 0 : n; });
  expect_decided(decide_label_numbers(lower.mesh, zero), universal, "no FDI numbers", lower.fdi);
}

TEST(LabelNumbers, AlongTheArchEitherEndMayBeFirstInAnyPose) {
  for (const Jaw jaw : {Jaw::lower, Jaw::upper})
    for (const auto& [numbers, length] : {std::pair{arch14, 14}, std::pair{arch16, 16}})
      for (int seed = 0; seed < 6; ++seed) {
        MadeArch arch = made_arch(teeth_of(jaw, length / 2), jaw);
        test::pose(arch.mesh, seed);
        const std::vector<int> raw = numbered_as(arch.fdi, numbers);
        LabelNumberOptions options;
        options.jaw = jaw;
        expect_decided(decide_label_numbers(arch.mesh, raw, options), numbers, "patient's right", arch.fdi);
        const int last = length + 1;
        const auto turned = renumbered(raw, [&](int n) { return n == 0 ? 0 : last - n; });
        expect_decided(decide_label_numbers(arch.mesh, turned, options), numbers, "patient's left", arch.fdi);
      }
}

TEST(LabelNumbers, AQuadrantBulgesToItsFrontAndSide) {
  for (const Jaw jaw : {Jaw::lower, Jaw::upper})
    for (const int quadrant : jaw == Jaw::lower ? std::vector{3, 4} : std::vector{1, 2}) {
      std::vector<int> teeth;
      for (int k = 1; k <= 7; ++k) teeth.push_back(10 * quadrant + k);
      const MadeArch arch = made_arch(teeth, jaw);
      LabelNumberOptions options;
      options.jaw = jaw;
      options.forced = arch14;
      expect_decided(decide_label_numbers(arch.mesh, numbered_as(arch.fdi, arch14), options), arch14, "by the form",
                     arch.fdi);
    }
}

TEST(LabelNumbers, WhatGeometryDoesNotTellIsAskedFor) {
  const MadeArch upper = made_arch({17, 16}, Jaw::upper), lower = made_arch({47, 46});
  LabelNumberOptions options;
  options.jaw = Jaw::upper;
  expect_decided(decide_label_numbers(upper.mesh, numbered_as(upper.fdi, arch14), options), arch14, "as is usual",
                 upper.fdi);
  expect_input_error([&] { decide_label_numbers(upper.mesh, numbered_as(upper.fdi, arch14)); }, "--jaw upper");
  options.jaw = Jaw::lower;
  expect_input_error([&] { decide_label_numbers(lower.mesh, numbered_as(lower.fdi, arch14), options); },
                     "do not show which end");
  options.first_is_patients_right = true;
  expect_decided(decide_label_numbers(lower.mesh, numbered_as(lower.fdi, arch14), options), arch14, "as was asked",
                 lower.fdi);
}

TEST(LabelNumbers, ElevenToSixteenAloneIsAskedForUnlessTold) {
  const MadeArch arch = made_arch({11, 12, 13, 14, 15, 16}, Jaw::upper);
  expect_input_error([&] { decide_label_numbers(arch.mesh, arch.fdi); }, "--labels-are fdi");
  LabelNumberOptions options;
  options.stated = fdi;
  expect_decided(decide_label_numbers(arch.mesh, arch.fdi, options), fdi, "as their source says", arch.fdi);
  options = {};
  options.forced = fdi;
  expect_decided(decide_label_numbers(arch.mesh, arch.fdi, options), fdi, "as was asked", arch.fdi);
  options = {};
  options.jaw = Jaw::lower;
  options.first_is_patients_right = true;
  EXPECT_EQ(decide_label_numbers(arch.mesh, arch.fdi, options).numbers, arch16);
}

TEST(LabelNumbers, ASourceIsNotBelievedAgainstItsNumbers) {
  const MadeArch lower = made_arch(teeth_of(Jaw::lower)), upper = made_arch(teeth_of(Jaw::upper), Jaw::upper);
  LabelNumberOptions options;
  options.stated = universal;
  expect_decided(decide_label_numbers(lower.mesh, lower.fdi, options), fdi, "34 is among them", lower.fdi);
  expect_decided(decide_label_numbers(upper.mesh, upper.fdi, options), fdi, "all of them are FDI", upper.fdi);
  options.stated = fdi;
  options.jaw = Jaw::upper;
  const std::vector<int> raw = numbered_as(upper.fdi, arch14);
  expect_decided(decide_label_numbers(upper.mesh, raw, options), arch14, "14 is the highest", upper.fdi);
  EXPECT_NE(decide_label_numbers(lower.mesh, lower.fdi, options).decided.find("said to be the upper"),
            std::string::npos);
}

TEST(LabelNumbers, UnknownNumbersAreNamed) {
  const MadeArch arch = made_arch(teeth_of(Jaw::lower));
  std::vector<int> raw = arch.fdi;
  raw[0] = 99;
  raw[1] = raw[2] = -3;
  expect_input_error([&] { decide_label_numbers(arch.mesh, raw); }, "-3 (on 2 vertices), 99 (on 1 vertex)");
  LabelNumberOptions options;
  options.forced = universal;
  expect_input_error([&] { decide_label_numbers(arch.mesh, arch.fdi, options); }, "34 (on");
  expect_input_error([&] { decide_label_numbers(arch.mesh, std::vector<int>(arch.fdi.size(), 0)); }, "no tooth");
  options.forced = universal;
  expect_input_error([&] { decide_label_numbers(arch.mesh, std::vector<int>(arch.fdi.size(), 33), options); },
                     "no tooth is labelled");
  EXPECT_THROW(decide_label_numbers(arch.mesh, {1, 2}), UsageError);
}

TEST(LabelNumbers, WhatHasNoNumberIsRefused) {
  expect_input_error([] { numbered_as({0, 55, 36}, universal); }, "none for 55");
  expect_input_error([] { numbered_as({0, 38, 36}, arch14); }, "none for 38");
  expect_input_error([] { numbered_as({26, 36}, arch16); }, "both jaws");
  EXPECT_EQ(numbered_as({0, 38, 48}, arch16), (std::vector<int>{0, 16, 1}));
  EXPECT_EQ(numbered_as({0, 37, 47, 31, 41}, arch14), (std::vector<int>{0, 14, 1, 8, 7}));
  EXPECT_EQ(numbered_as({0, 55, 36}, fdi), (std::vector<int>{0, 55, 36}));
  for (int number = 11; number < 90; ++number) {
    if (!is_permanent_tooth(number) && !is_milk_tooth(number)) continue;
    EXPECT_EQ(jaw_of_fdi(number) == Jaw::upper, number / 10 % 4 == 1 || number / 10 % 4 == 2) << number;
  }
}

}  // namespace
}  // namespace rhizodont
