// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "batch/ledger.hpp"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace rhizodont {

/// What became of a case, by the latest line about it.
struct CaseStatus {
  std::string id, key, reason, scan;  ///< `scan`: only of a batch that keeps names
  int code = 0;
  std::size_t teeth = 0, rooted = 0;
  double time = 0;  ///< s since 1970
};

enum class RunState {
  running,
  silent,  ///< no line for a long time: it was killed, or is at a very large case
  ended,   ///< done, or stopped by a signal or a full disk
};

/// The latest run of a shard.
struct ShardStatus {
  std::size_t shard = 0, shards = 0;  ///< from 1
  RunState state = RunState::ended;
  std::size_t cases = 0, dealt_with = 0;
  std::string at;  ///< the case that it is at
  double seconds_since_last_line = 0;
  std::optional<double> seconds_left;
};

struct BatchStatus {
  std::size_t cases = 0;  ///< of the batch
  std::size_t done = 0, partial = 0, failed = 0;
  std::size_t teeth = 0, rooted = 0;
  std::size_t running = 0;  ///< cases at work
  std::vector<ShardStatus> shards;
  /// Why cases failed and teeth have no roots, the most frequent first.
  std::vector<std::pair<std::string, std::size_t>> reasons;
  std::vector<CaseStatus> by_case;     ///< in the order of their ids: numbers by value, then others
  std::optional<double> seconds_left;  ///< until the last running shard is through

  std::size_t remaining() const { return cases - done - partial - failed; }
};

/// Where a batch stands: of all runs of the manifest and options that were started last. May be asked at any time while
/// shards run. Throws InputError where the folder has no ledger.
/// @param now  s since 1970
BatchStatus batch_status(const std::filesystem::path& batch, double now);

nlohmann::ordered_json batch_status_json(const BatchStatus& status);

/// "3 h 20 min", "12 min", "40 s".
std::string duration_text(double seconds);

}  // namespace rhizodont
