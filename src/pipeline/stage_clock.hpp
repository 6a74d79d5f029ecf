// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/complete.hpp"

#include <chrono>
#include <string>

namespace rhizodont {

/// Notes time and memory of the stages as they follow each other; of one that is taken up again, the sum.
class StageClock {
 public:
  explicit StageClock(const ProgressCallback& progress) : progress_(progress) {}

  /// Ends the stage before, if any, and begins the next.
  void begin(const std::string& name);
  /// Ends the last stage and hands over the notes.
  std::vector<StageRecord> finish();

 private:
  void end_stage();

  const ProgressCallback& progress_;
  std::vector<StageRecord> records_;
  std::size_t current_ = 0;
  std::chrono::steady_clock::time_point started_;
  bool running_ = false;
};

}  // namespace rhizodont
