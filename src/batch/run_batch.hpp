// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "batch/batch_models.hpp"
#include "batch/case_key.hpp"
#include "batch/manifest.hpp"
#include "batch/shard.hpp"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

namespace rhizodont {

struct BatchOptions {
  CaseOptions cases;
  BatchShard shard;
  bool retry_failed = false;  ///< cases that failed before, wholly or for some teeth, are done again
  int threads = 0;            ///< at most so many; 0: all that the caller may use
};

/// A case that has just been dealt with.
struct FinishedCase {
  std::string id;
  int code = 0;  ///< as BatchOutcome's
  std::string reason;
  std::size_t teeth = 0, rooted = 0;
  bool from_before = false;  ///< its results, or its failure, were there already
  double seconds = 0;
};

/// How far a shard is.
struct BatchProgress {
  std::size_t cases = 0;  ///< of the shard
  std::size_t done = 0, partial = 0, failed = 0;
  std::optional<double> seconds_left;  ///< once a case has been completed in this run

  std::size_t dealt_with() const { return done + partial + failed; }
};

struct BatchCallbacks {
  std::function<void(const FinishedCase&, const BatchProgress&)> finished;  ///< after each case
  std::function<bool()> stop;  ///< asked often: whether to give up the case at work and end; may be empty
};

struct BatchResult {
  BatchProgress progress;
  bool stopped = false;
};

/// A case that ended the program so often (no memory, a fault) is not tried again, so that the others get their turn.
inline constexpr std::size_t most_endings = 3;

/// Does all cases of a shard that have no result yet, one after the other, the teeth of each in parallel, and puts what
/// comes out into `folder`: results into cases/KEY (`place_case`), what happened into the ledger. A case whose folder
/// is there and complete is not done again; failures are remembered likewise. Files that cannot be read are tried each
/// time. A case that fails does not stop the others; a killed run loses the case that it was at.
/// The union of all shards' results has always the same bytes, in how many parts and runs ever it was made.
/// Throws OutputError where results cannot be written, which ends the run.
BatchResult run_batch(const BatchManifest& manifest, const BatchModels& models, const BatchOptions& options,
                      const std::filesystem::path& folder, const BatchCallbacks& callbacks = {});

}  // namespace rhizodont
