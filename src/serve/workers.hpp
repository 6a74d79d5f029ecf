// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace rhizodont::serve {

/// A few threads that compute, and a short queue before them.
class Workers {
 public:
  Workers(std::size_t threads, std::size_t waiting);
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;
  /// Waits for what is at work; what has not begun is dropped.
  ~Workers();

  /// False if the queue is full. An urgent task (a slider's) goes before those that wait. Tasks throw nothing.
  bool add(std::function<void()> task, bool urgent = false);

  /// Takes nothing on any more and drops what has not begun.
  void stop();

  std::size_t waiting() const;
  std::size_t running() const;

 private:
  void work();

  std::size_t most_waiting_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<void()>> tasks_;
  std::size_t running_ = 0;
  bool stopping_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace rhizodont::serve
