// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/parallel_tasks.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <numeric>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace rhizodont {
namespace {

/// Sums 1 .. n by a parallel loop that takes a while.
int slow_sum(int n) {
  std::vector<int> values(static_cast<std::size_t>(n), 0);
  tbb::parallel_for(std::size_t{0}, values.size(), [&](std::size_t i) {
    std::this_thread::sleep_for(std::chrono::microseconds(200));
    values[i] = static_cast<int>(i) + 1;
  });
  return std::accumulate(values.begin(), values.end(), 0);
}

TEST(ParallelTasks, LoopsInsideComeToTheirEndWhereAnotherTaskThrows) {
  constexpr int numbers = 200;
  std::atomic<int> whole = 0, begun = 0;
  EXPECT_THROW(parallel_tasks(8,
                              [&](int i) {
                                if (i % 2 == 1) {
                                  std::this_thread::sleep_for(std::chrono::milliseconds(2));
                                  throw std::runtime_error("task " + std::to_string(i));
                                }
                                ++begun;
                                if (slow_sum(numbers) == numbers * (numbers + 1) / 2) ++whole;
                              }),
               std::runtime_error);
  int thrown = 0;
  EXPECT_THROW(parallel_pair([&] { thrown += slow_sum(numbers); },
                             [] {
                               std::this_thread::sleep_for(std::chrono::milliseconds(2));
                               throw std::bad_alloc();
                             }),
               std::bad_alloc);
  EXPECT_TRUE(thrown == 0 || thrown == numbers * (numbers + 1) / 2);  // not begun, or done
  EXPECT_GE(begun, 1);
  EXPECT_EQ(whole, begun);
}

TEST(ParallelTasks, OfWhatIsThrownTheLowestNumberGoesOn) {
  const auto most_throw = [] {
    parallel_tasks(64, [](int i) {
      if (i % 2 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
      if (i >= 5) throw std::runtime_error(std::to_string(i));
    });
  };
  try {
    most_throw();
    ADD_FAILURE() << "nothing was thrown";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "5");
  }
}

TEST(ParallelTasks, EachRunsOnce) {
  std::vector<std::atomic<int>> runs(1000);
  parallel_tasks(runs.size(), [&](std::size_t i) { ++runs[i]; });
  for (const std::atomic<int>& count : runs) EXPECT_EQ(count, 1);
  parallel_tasks(0, [](int) { throw std::runtime_error("no task"); });
}

}  // namespace
}  // namespace rhizodont
