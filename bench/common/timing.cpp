// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/timing.hpp"

#include "base/stopwatch.hpp"

#include <algorithm>
#include <cmath>

namespace rhizodont {

double median_seconds(const std::function<void()>& work, int repeats) {
  work();
  std::vector<double> seconds;
  for (int i = 0; i < repeats; ++i) {
    const Stopwatch watch;
    work();
    seconds.push_back(watch.seconds());
  }
  const auto middle = seconds.begin() + static_cast<std::ptrdiff_t>(seconds.size() / 2);
  std::nth_element(seconds.begin(), middle, seconds.end());
  return *middle;
}

LinearGrowth fit_linear_growth(const std::vector<double>& sizes, const std::vector<double>& seconds) {
  double logarithms = 0;
  for (std::size_t i = 0; i < sizes.size(); ++i) logarithms += std::log(seconds[i] / sizes[i]);
  LinearGrowth growth;
  growth.seconds_per_unit = std::exp(logarithms / static_cast<double>(sizes.size()));
  for (std::size_t i = 0; i < sizes.size(); ++i)
    growth.largest_deviation =
        std::max(growth.largest_deviation, std::abs(seconds[i] / (growth.seconds_per_unit * sizes[i]) - 1));
  return growth;
}

}  // namespace rhizodont
