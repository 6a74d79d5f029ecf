// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "command_line/output_options.hpp"
#include "learning/training_options.hpp"
#include "networks/safetensors.hpp"
#include "training/model_card.hpp"

namespace rhizodont::command_line {

/// Tunes this process for training and warns of a slow BLAS on standard error.
void prepare_for_training();

/// Prints each report with the time, unless nothing is to be said.
std::function<void(const TrainingProgress&)> progress_of(const OutputOptions& said);

/// Before the work: that the file of figures, if any, can be written and is none of the inputs: files, and all below
/// folders; names may be empty. Throws as require_safe_outputs.
void require_place_for_figures(const OutputOptions& said, const std::vector<std::filesystem::path>& inputs = {});

/// In the end: the figures to where they were asked for (--json).
void give_figures(const OutputOptions& said, const nlohmann::ordered_json& figures);

/// What differs between the networks whose weights are exported.
struct WeightExport {
  std::filesystem::path folder;  ///< of the training
  std::filesystem::path weights;
  bool overwrite = false;  ///< an older card may be replaced
  std::function<TensorFile(const std::filesystem::path& folder, const std::map<std::string, std::string>& notes)> read;
  std::function<std::string(const WeightFile&)> card;
  OutputOptions said;
};

/// Writes a folder's best weights and, beside them, the model card. Throws as require_safe_export and the functions.
void export_weights(const WeightExport& what);

}  // namespace rhizodont::command_line
