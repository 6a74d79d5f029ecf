// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/stopwatch.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>

namespace rhizodont {

double median_seconds(const std::function<void()>& work, int repeats) {
  work();
  std::vector<double> seconds;
  for (int i = 0; i < repeats; ++i) {
    const auto start = std::chrono::steady_clock::now();
    work();
    seconds.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
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

double peak_memory_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

}  // namespace rhizodont
