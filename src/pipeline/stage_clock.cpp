// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "pipeline/stage_clock.hpp"

#include <sys/resource.h>

#include <algorithm>

namespace rhizodont {
namespace {

double peak_memory_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;  // Linux counts in KiB
}

}  // namespace

void StageClock::begin(const std::string& name) {
  end_stage();
  if (progress_) {
    try {
      progress_(name);
    } catch (...) {
      throw ThrownByCallback{std::current_exception()};
    }
  }
  const auto same =
      std::find_if(records_.begin(), records_.end(), [&](const StageRecord& record) { return record.name == name; });
  current_ = static_cast<std::size_t>(same - records_.begin());
  if (same == records_.end()) records_.push_back({name, 0, 0});
  started_ = std::chrono::steady_clock::now();
  running_ = true;
}

std::vector<StageRecord> StageClock::finish() {
  end_stage();
  return std::move(records_);
}

void StageClock::end_stage() {
  if (!running_) return;
  records_[current_].seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - started_).count();
  records_[current_].peak_memory_mb = peak_memory_mb();
  running_ = false;
}

}  // namespace rhizodont
