// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>

#include <atomic>
#include <cassert>
#include <concepts>
#include <cstddef>
#include <exception>
#include <vector>

namespace rhizodont {

/// Runs task(0) .. task(count - 1) in parallel, where the tasks run loops in parallel themselves. An exception that
/// leaves the body of oneTBB's own loops cancels, without a word, the loops inside all of its other bodies, which then
/// go on with results that are half filled. Here each task that has begun comes to its end; those of higher numbers
/// than one that has thrown are left out, so that of all exceptions that of the lowest number is thrown on, whatever
/// the threads do. Each task is one unit of work. `count` >= 0.
template <std::integral Number, class Task>
void parallel_tasks(Number count, const Task& task) {
  assert(count >= Number{0});
  const auto tasks = static_cast<std::size_t>(count);
  std::vector<std::exception_ptr> thrown(tasks);
  std::atomic<std::size_t> lowest = tasks;  // of those that have thrown
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, tasks, 1),
      [&](const tbb::blocked_range<std::size_t>& range) {
        for (std::size_t i = range.begin(); i < range.end() && i < lowest; ++i) {
          try {
            task(static_cast<Number>(i));
          } catch (...) {
            thrown[i] = std::current_exception();
            std::size_t before = lowest;
            while (i < before && !lowest.compare_exchange_weak(before, i)) {
            }
          }
        }
      },
      tbb::simple_partitioner());
  if (lowest < tasks) std::rethrow_exception(thrown[lowest]);
}

/// Both, side by side, as `parallel_tasks` runs them.
template <class First, class Second>
void parallel_pair(const First& first, const Second& second) {
  parallel_tasks(2, [&](int i) { i == 0 ? first() : second(); });
}

}  // namespace rhizodont
