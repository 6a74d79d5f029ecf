// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "pipeline/stage_clock.hpp"

#include "base/peak_memory.hpp"

#include <algorithm>

namespace rhizodont {
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
  watch_.restart();
  running_ = true;
}

std::vector<StageRecord> StageClock::finish() {
  end_stage();
  return std::move(records_);
}

void StageClock::end_stage() {
  if (!running_) return;
  records_[current_].seconds += watch_.seconds();
  records_[current_].peak_memory_mb = peak_memory_mb();
  running_ = false;
}

}  // namespace rhizodont
