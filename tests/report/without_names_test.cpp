// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "report/without_names.hpp"

#include <gtest/gtest.h>

namespace rhizodont {
namespace {

TEST(WithoutNames, FilesAndTheirWordsAreNotQuoted) {
  EXPECT_EQ(without_names("/scans/miller/upper.obj: line 3 begins with 'Miller'.", {"/scans/miller/upper.obj"}),
            "the file: line 3 begins with a word.");
  EXPECT_EQ(without_names("upper.obj is no mesh.", {"/scans/miller/upper.obj"}), "the file is no mesh.");
}

TEST(WithoutNames, WordsOfFormatsAndApostrophesStay) {
  EXPECT_EQ(without_names("After 'facet' no 'loop' follows.", {}), "After 'facet' no 'loop' follows.");
  EXPECT_EQ(without_names("The tooth's root, and its neighbour's.", {}), "The tooth's root, and its neighbour's.");
}

}  // namespace
}  // namespace rhizodont
