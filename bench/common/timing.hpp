// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <vector>

namespace rhizodont {

/// Median wall-clock time in seconds of `repeats` (>= 1) runs of `work`, after one run that is not counted.
double median_seconds(const std::function<void()>& work, int repeats = 5);

/// Slope and largest relative deviation of measurements from the straight line through the origin that fits them best
/// in the relative sense. `sizes` and `seconds` have the same length, at least 2, and are positive.
struct LinearGrowth {
  double seconds_per_unit = 0;
  double largest_deviation = 0;  ///< 0.2: some measurement lies 20 % off the line
};
LinearGrowth fit_linear_growth(const std::vector<double>& sizes, const std::vector<double>& seconds);

}  // namespace rhizodont
