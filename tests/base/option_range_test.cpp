// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/option_range.hpp"

#include "rhizodont/error.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

namespace rhizodont {
namespace {

std::string refusal(double value, const OptionRange& range) {
  try {
    require_ranges("a test", {{"first", 1, OptionRange::at_least(1)}, {"second", value, range}});
    return {};
  } catch (const UsageError& error) {
    return error.what();
  }
}

TEST(OptionRange, EndsBelongToItOrNot) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  EXPECT_EQ(refusal(0, OptionRange::at_least(0)), "");
  EXPECT_EQ(refusal(-1, OptionRange::at_least(0)), "The option second of a test is -1, out of its range: at least 0.");
  EXPECT_EQ(refusal(0, OptionRange::above(0).below(1)),
            "The option second of a test is 0, out of its range: above 0 and below 1.");
  EXPECT_NE(refusal(1, OptionRange::above(0).below(1)), "");
  EXPECT_EQ(refusal(1, share_range), "");
  EXPECT_EQ(refusal(1.5, share_range),
            "The option second of a test is 1.5, out of its range: at least 0 and at most 1.");
  EXPECT_NE(refusal(infinite, OptionRange::at_least(0)), "");
  EXPECT_NE(refusal(std::nan(""), OptionRange::at_least(0)), "");
  EXPECT_NE(refusal(std::nan(""), share_range), "");
}

}  // namespace
}  // namespace rhizodont
