// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "base/conformal_quantile.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <vector>

namespace rhizodont {
namespace {

TEST(ConformalQuantile, IsOneOfTheValuesInAnyOrder) {
  EXPECT_EQ(conformal_quantile({7, 1, 9, 3, 5}, 0.5), 5);
  EXPECT_EQ(conformal_quantile({2}, 0.8), 2);
  EXPECT_EQ(conformal_quantile({4, 6}, 0), 4);
  EXPECT_EQ(conformal_quantile({4, 6}, 1), 6) << "more than the values tell: the largest";
}

TEST(ConformalQuantile, ALeftOutValueLiesBelowItOftenEnough) {
  // What makes an interval hold the truth with the probability that is stated. Of values that could as well have come
  // in any order each is left out once.
  for (const double share : {0.25, 0.5, 0.75, 0.8, 0.9})
    for (std::size_t n = 9; n < 40; ++n) {
      std::size_t below = 0, below_next = 0;
      for (std::size_t out = 0; out <= n; ++out) {
        std::vector<double> others;
        for (std::size_t i = 0; i <= n; ++i)
          if (i != out) others.push_back(static_cast<double>(i));
        const double bound = conformal_quantile(others, share);
        below += static_cast<double>(out) <= bound;
        below_next += static_cast<double>(out) <= bound - 1.5;  // a bound one value lower
      }
      const double needed = share * static_cast<double>(n + 1);
      EXPECT_GE(static_cast<double>(below), needed) << share << " of " << n;
      EXPECT_LT(static_cast<double>(below_next), needed) << "no wider than it must be: " << share << " of " << n;
    }
}

}  // namespace
}  // namespace rhizodont
