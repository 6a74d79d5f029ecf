// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "poisson/indicator.hpp"

#include <gtest/gtest.h>

#include "poisson/shapes.hpp"

namespace rhizodont {
namespace {

TEST(Indicator, IsOneInsideAndZeroOutsideASphere) {
  const OrientedPoints samples = shapes::sphere(5000, 4.0, Point(1.0, 2.0, 3.0));
  const IndicatorFunction chi = solve_indicator(samples);
  EXPECT_NEAR(chi.value(Point(1.0, 2.0, 3.0)), 1.0, 0.05);
  EXPECT_NEAR(chi.value(Point(1.0, 2.0, 7.9)), 0.0, 0.05);
  EXPECT_NEAR(chi.iso_value(), 0.5, 0.03);
}

}  // namespace
}  // namespace rhizodont
