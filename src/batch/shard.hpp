// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace rhizodont {

/// A part of a batch: of its cases every `count`-th, from the `index`-th on, both counted from 0. Whatever `count`,
/// each case belongs to one shard.
struct BatchShard {
  std::size_t index = 0, count = 1;

  bool holds(std::size_t place) const { return place % count == index; }
  /// As users write it and files are called: "1-of-4", counted from 1.
  std::string name() const;
  bool operator==(const BatchShard&) const = default;
};

/// "1/4" to "4/4". Throws UsageError for anything else.
BatchShard read_shard(std::string_view text);

/// What a variable of the environment holds, or nothing.
using EnvironmentVariable = std::function<std::optional<std::string>(const char* name)>;

/// The shard that a scheduler gives this process: of a Slurm array (SLURM_ARRAY_TASK_ID, _MIN, _MAX, _STEP, _COUNT),
/// else of an indexed Kubernetes job (JOB_COMPLETION_INDEX, and JOB_COMPLETIONS, which the job's file sets); else the
/// whole. Throws UsageError where they do not say which part of how many this is, as of an array with gaps.
BatchShard shard_of_environment(const EnvironmentVariable& variable);

}  // namespace rhizodont
