// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>

#include <algorithm>
#include <atomic>
#include <concepts>
#include <cstddef>
#include <exception>
#include <vector>

namespace rhizodont {

/// Runs task(0) .. task(count - 1) in parallel, where the tasks run loops in parallel themselves. An exception that
/// leaves the body of oneTBB's own loops cancels, without a word, the loops inside all of its other bodies, which then
/// go on with results that are half filled. Here each task that has begun comes to its end; those that have not are
/// left out once one has thrown, and of the exceptions that of the lowest number is thrown on. Each task is one unit of
/// work.
template <std::integral Number, class Task>
void parallel_tasks(Number count, const Task& task) {
  const auto tasks = static_cast<std::size_t>(count);
  std::vector<std::exception_ptr> thrown(tasks);
  std::atomic<bool> has_thrown = false;
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, tasks, 1),
      [&](const tbb::blocked_range<std::size_t>& range) {
        for (std::size_t i = range.begin(); i < range.end() && !has_thrown; ++i) {
          try {
            task(static_cast<Number>(i));
          } catch (...) {
            thrown[i] = std::current_exception();
            has_thrown = true;
          }
        }
      },
      tbb::simple_partitioner());
  const auto first =
      std::find_if(thrown.begin(), thrown.end(), [](const std::exception_ptr& e) { return e != nullptr; });
  if (first != thrown.end()) std::rethrow_exception(*first);
}

/// Both, side by side, as `parallel_tasks` runs them.
template <class First, class Second>
void parallel_pair(const First& first, const Second& second) {
  parallel_tasks(2, [&](int i) { i == 0 ? first() : second(); });
}

}  // namespace rhizodont
