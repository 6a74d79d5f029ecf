// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "batch/shard.hpp"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

// What happened in a batch, as lines of JSON: docs/batches.md. Each run of each shard appends to a file of its own,
// FOLDER/ledger/SHARD.RUN.jsonl, so that no two processes ever write to one file and nobody needs a lock, which network
// disks do not always keep.
namespace rhizodont {

inline constexpr int ledger_version = 1;

/// The file that a running shard appends to.
class BatchLedger {
 public:
  /// Makes the file, under a name that no other run has. Throws OutputError.
  BatchLedger(const std::filesystem::path& batch, const BatchShard& shard);
  BatchLedger(const BatchLedger&) = delete;
  BatchLedger& operator=(const BatchLedger&) = delete;
  ~BatchLedger();

  /// SHARD.RUN: of this run alone.
  const std::string& run() const { return run_; }

  /// Appends the lines, each with the time in seconds since 1970 ("time"), in one write, and brings them to the disk.
  /// Throws OutputError.
  void append(std::vector<nlohmann::ordered_json> lines);

 private:
  [[noreturn]] void fail(int error) const;

  std::filesystem::path path_;
  std::string run_;
  int descriptor_ = -1;
};

/// One run's lines, oldest first.
struct LedgerFile {
  std::string run;
  std::vector<nlohmann::ordered_json> lines;
  std::size_t unreadable = 0;  ///< lines that are no JSON objects, such as one that a kill cut off
};

/// All ledgers of a batch, by the names of the runs; none if there is no such folder. Throws InputError for a file that
/// cannot be read.
std::vector<LedgerFile> read_ledgers(const std::filesystem::path& batch);

/// A line's text entry, or "" if it has none of that name; a number likewise, or 0.
std::string text_in(const nlohmann::ordered_json& line, const char* name);
double number_in(const nlohmann::ordered_json& line, const char* name);

}  // namespace rhizodont
