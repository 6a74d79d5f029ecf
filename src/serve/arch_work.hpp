// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "arch/arch_memory.hpp"
#include "base/tooth_labels.hpp"
#include "report/scan_input.hpp"
#include "rhizodont/mesh.hpp"

#include <cstddef>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <utility>

namespace rhizodont::serve {

/// All that a scan's labels depend on before a person corrects them: the same question about the same scan has the same
/// answer.
struct LabelQuestion {
  std::string array;
  std::optional<LabelNumbers> numbers;
  std::optional<Jaw> jaw;
  std::optional<bool> first_is_patients_right;
  double millimetres_per_unit = 1;
  std::set<int> missing;
  std::map<int, Point> teeth;

  bool operator==(const LabelQuestion&) const = default;
};

/// What is known of a scan as an arch, so that its next job does no more than is needed.
struct ArchWork {
  LabelQuestion question;
  std::shared_ptr<const ScanInput> input;  ///< the question's answer; null: nothing is known
  ArchMemory memory;
};

/// Where that lies between two jobs, beside the scan; forgotten with it. May be used from several threads.
class ArchShelf {
 public:
  /// Empty where there is nothing, or another job has it.
  ArchWork take() {
    const std::scoped_lock lock(mutex_);
    return std::exchange(work_, {});
  }
  void put(ArchWork work) {
    const std::scoped_lock lock(mutex_);
    work_ = std::move(work);
  }

 private:
  std::mutex mutex_;
  ArchWork work_;
};

/// Sees to it that only the last few scans have such a shelf with something on it: it takes memory. May be used from
/// several threads.
class FewShelves {
 public:
  explicit FewShelves(std::size_t most) : most_(most) {}

  /// A shelf that is about to be used; the one that was not for longest makes place.
  void use(const std::shared_ptr<ArchShelf>& shelf) {
    const std::scoped_lock lock(mutex_);
    std::erase_if(used_, [&](const std::weak_ptr<ArchShelf>& other) {
      const auto there = other.lock();
      return !there || there == shelf;
    });
    used_.push_back(shelf);
    for (; used_.size() > most_; used_.pop_front())
      if (const auto oldest = used_.front().lock()) oldest->take();
  }

 private:
  std::size_t most_;
  std::mutex mutex_;
  std::deque<std::weak_ptr<ArchShelf>> used_;
};

}  // namespace rhizodont::serve
