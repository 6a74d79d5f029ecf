// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "teeth/correct_labels.hpp"
#include "teeth/made_arch.hpp"

#include <set>

namespace rhizodont {
namespace {

using test::made_arch, test::MadeArch, test::place_in_arch, test::teeth_of;
using Kind = LabelCorrection::Kind;

std::set<int> numbers_of(const std::vector<int>& fdi) { return {fdi.begin(), fdi.end()}; }

Point top_of(const MadeArch& arch, int place, Jaw jaw = Jaw::lower) {
  const Point at = place_in_arch(place, jaw);
  return arch.mesh.vertices[static_cast<std::size_t>(arch.nearest_vertex(at.x(), at.y()))];
}

void expect_usage_error(const MadeArch& arch, const LabelCorrection& correction, const std::string& words) {
  try {
    correct_labels(arch.mesh, arch.fdi, {correction});
    ADD_FAILURE() << "accepted, expected: " << words;
  } catch (const UsageError& error) {
    EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
  }
}

TEST(CorrectLabels, ToothThatIsPointedAtGetsItsNumber) {
  const MadeArch arch = made_arch({46, 45, 44, 36});
  const int old = fdi_of_arch_place(4, 16, Jaw::lower);  // 45
  const CorrectedLabels got = correct_labels(arch.mesh, arch.fdi, {{Kind::number, 47, 0, top_of(arch, 4)}});
  EXPECT_EQ(numbers_of(got.fdi), (std::set<int>{0, 36, 44, 46, 47}));
  for (std::size_t v = 0; v < got.fdi.size(); ++v) EXPECT_EQ(got.fdi[v], arch.fdi[v] == old ? 47 : arch.fdi[v]);
  ASSERT_EQ(got.notes.size(), 1U);
  EXPECT_NE(got.notes[0].find("45"), std::string::npos) << got.notes[0];
}

TEST(CorrectLabels, NumberThatIsTakenIsExchanged) {
  const MadeArch arch = made_arch({46, 45, 44, 36});
  const std::vector<int> got = correct_labels(arch.mesh, arch.fdi, {{Kind::number, 46, 0, top_of(arch, 4)}}).fdi;
  for (std::size_t v = 0; v < got.size(); ++v)
    EXPECT_EQ(got[v], arch.fdi[v] == 45 ? 46 : arch.fdi[v] == 46 ? 45 : arch.fdi[v]);
}

TEST(CorrectLabels, TwoTeethUnderOneNumberAreDividedWhereTheyMeet) {
  for (const Jaw jaw : {Jaw::lower, Jaw::upper})
    for (const int seed : {0, 3}) {
      MadeArch whole = made_arch(teeth_of(jaw), jaw);
      if (seed != 0) test::pose(whole.mesh, seed);
      const int first = fdi_of_arch_place(4, 16, jaw), second = fdi_of_arch_place(5, 16, jaw);
      for (const auto& [old, fdi] : {std::pair(first, second), std::pair(second, first)}) {
        MadeArch merged = whole;
        for (int& label : merged.fdi) label = label == fdi ? old : label;
        Point meet = Point::Zero();
        std::size_t count = 0;
        for (std::size_t v = 0; v < whole.fdi.size(); ++v)
          if (whole.fdi[v] == first || whole.fdi[v] == second) meet += whole.mesh.vertices[v], ++count;
        const std::vector<int> got =
            correct_labels(merged.mesh, merged.fdi, {{Kind::split, fdi, 0, meet / static_cast<double>(count)}}, 0.5)
                .fdi;
        EXPECT_EQ(got, whole.fdi) << old << " of which a part is " << fdi << ", pose " << seed;
      }
    }
}

TEST(CorrectLabels, TwoPartsBecomeOneAndWhatIsNoneIsGum) {
  const MadeArch arch = made_arch({46, 45, 44, 36});
  const CorrectedLabels got =
      correct_labels(arch.mesh, arch.fdi, {{Kind::merge, 46, 45, {}}, {Kind::remove, 36, 0, {}}});
  EXPECT_EQ(numbers_of(got.fdi), (std::set<int>{0, 44, 46}));
  EXPECT_EQ(got.notes.size(), 2U);
}

TEST(CorrectLabels, WhatCannotBeIsSaid) {
  const MadeArch arch = made_arch({46, 45, 44, 36});
  const Point on_45 = top_of(arch, 4);
  expect_usage_error(arch, {Kind::number, 39, 0, on_45}, "no tooth 39");
  expect_usage_error(arch, {Kind::number, 47, 0, {0, 0, 90}}, "no tooth at the place");
  expect_usage_error(arch, {Kind::merge, 46, 37, {}}, "no tooth 37");
  expect_usage_error(arch, {Kind::merge, 46, 46, {}}, "itself");
  expect_usage_error(arch, {Kind::remove, 31, 0, {}}, "no tooth 31");
  expect_usage_error(arch, {Kind::split, 44, 0, on_45}, "there is one already");
  expect_usage_error(arch, {Kind::split, 47, 0, on_45 + Point(1.9, 0, 0)}, "cannot be divided there");
}

}  // namespace
}  // namespace rhizodont
