// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "base/stopwatch.hpp"
#include "rhizodont/complete.hpp"

#include <exception>
#include <string>
#include <vector>

namespace rhizodont {

/// What a progress callback threw, in a wrapper that nothing on the way takes for an error of the work itself.
struct ThrownByCallback {
  std::exception_ptr thrown;
};

/// Runs `work`; what a progress callback throws within comes out of it as it was thrown.
template <class Work>
auto letting_callbacks_throw(const Work& work) {
  try {
    return work();
  } catch (const ThrownByCallback& wrapper) {
    std::rethrow_exception(wrapper.thrown);
  }
}

/// Notes time and memory of the stages as they follow each other; of one that is taken up again, the sum.
class StageClock {
 public:
  explicit StageClock(const ProgressCallback& progress) : progress_(progress) {}

  /// Ends the stage before, if any, and begins the next. Throws ThrownByCallback.
  void begin(const std::string& name);
  /// Ends the last stage and hands over the notes.
  std::vector<StageRecord> finish();

 private:
  void end_stage();

  const ProgressCallback& progress_;
  std::vector<StageRecord> records_;
  std::size_t current_ = 0;
  Stopwatch watch_;  // of the stage at work
  bool running_ = false;
};

}  // namespace rhizodont
