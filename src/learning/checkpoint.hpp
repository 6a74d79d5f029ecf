// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Private to this room: brings in torch.

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "learning/optimiser.hpp"
#include "networks/safetensors.hpp"

namespace rhizodont {

// Names in a training folder.
inline constexpr const char* checkpoint_name = "checkpoint.safetensors";
inline constexpr const char* best_name = "best.safetensors";

/// A folder (empty: none is wanted) that can be written to and holds no weights of another run that this one would
/// replace. Throws UsageError or OutputError.
void require_training_folder(const std::filesystem::path& folder, bool resume);

/// How far a training run has come.
struct CheckpointProgress {
  std::uint64_t samples = 0, steps = 0;
  double best = 0;  ///< figure on held-out samples by which weights are kept
};

/// The weights of a training folder: its best ones, or the checkpoint's running mean, stored as `type`, if it was never
/// validated. With the metadata of that file and `notes`. Throws InputError if the folder has no weights.
TensorFile weights_of_run(const std::filesystem::path& folder, TensorType type,
                          const std::map<std::string, std::string>& notes);

/// Notes parameters, the optimiser's state and the progress of a run in a checkpoint.
void store_progress(const std::vector<TrainedTensor>& tensors, const CheckpointProgress& progress, TensorFile& file);

/// Reads these back. `wanted`: metadata that the run must have been made with. `folder`: of the run, for messages.
/// Throws InputError for a checkpoint of another run, without a tensor or without its progress.
CheckpointProgress load_progress(const TensorFile& file, const std::map<std::string, std::string>& wanted,
                                 const std::filesystem::path& folder, std::vector<TrainedTensor>& tensors);

}  // namespace rhizodont
