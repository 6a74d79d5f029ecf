// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "batch/shard.hpp"

#include "rhizodont/error.hpp"

#include <fmt/format.h>

#include <charconv>

namespace rhizodont {
namespace {

std::optional<std::size_t> whole_number(std::string_view text) {
  std::size_t number = 0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), number);
  return failure == std::errc() && end == text.data() + text.size() ? std::optional(number) : std::nullopt;
}

std::size_t number_of(const EnvironmentVariable& variable, const char* name,
                      std::optional<std::size_t> otherwise = {}) {
  const auto text = variable(name);
  const auto number = text ? whole_number(*text) : otherwise;
  if (!number)
    throw UsageError(fmt::format("The environment's {} {}: say which part of the batch this is (--shard 1/4).", name,
                                 text ? "is no whole number" : "is missing"));
  return *number;
}

BatchShard shard_of_slurm(const EnvironmentVariable& variable) {
  const std::size_t id = number_of(variable, "SLURM_ARRAY_TASK_ID"),
                    least = number_of(variable, "SLURM_ARRAY_TASK_MIN"),
                    count = number_of(variable, "SLURM_ARRAY_TASK_COUNT"),
                    step = number_of(variable, "SLURM_ARRAY_TASK_STEP", 1);
  const std::size_t most = number_of(variable, "SLURM_ARRAY_TASK_MAX", id), after = id - least;
  if (id < least || step == 0 || after % step != 0 || after / step >= count || (most - least) / step >= count)
    throw UsageError(
        "This Slurm array has gaps, so that it does not say which part of the batch a task is: give --shard.");
  return {after / step, count};
}

}  // namespace

std::string BatchShard::name() const { return fmt::format("{}-of-{}", index + 1, count); }

BatchShard read_shard(std::string_view text) {
  const std::size_t slash = text.find('/');
  const auto part = whole_number(text.substr(0, slash));
  const auto count = slash == std::string_view::npos ? std::nullopt : whole_number(text.substr(slash + 1));
  if (!part || !count || *part < 1 || *part > *count)
    throw UsageError(fmt::format("--shard takes a part and how many there are, 1/4 to 4/4, not '{}'.", text));
  return {*part - 1, *count};
}

BatchShard shard_of_environment(const EnvironmentVariable& variable) {
  if (variable("SLURM_ARRAY_TASK_ID")) return shard_of_slurm(variable);
  if (!variable("JOB_COMPLETION_INDEX")) return {};
  const std::size_t index = number_of(variable, "JOB_COMPLETION_INDEX"), count = number_of(variable, "JOB_COMPLETIONS");
  if (index >= count) throw UsageError("JOB_COMPLETION_INDEX is not below JOB_COMPLETIONS.");
  return {index, count};
}

}  // namespace rhizodont
