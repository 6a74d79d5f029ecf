// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

#include "learning/training_options.hpp"
#include "networks/completion_shape.hpp"
#include "networks/safetensors.hpp"
#include "training/completion_training_sample.hpp"
#include "training/sample_numbers.hpp"

namespace rhizodont {

/// Settings of `train_completion`; each >= 0 where nothing else is said.
struct CompletionTrainingOptions {
  CompletionShape shape;
  TrainingLoopOptions loop;
  double unknown_share = 0.1;    ///< share of samples whose type is hidden, 0..1
  double root_weight = 3;        ///< weight of target points below the crown beside those on it, > 0
  double coarse_weight = 0.5;    ///< of the queries' starting points
  double denoise_weight = 0.5;   ///< of the denoising queries
  double chamfer_weight = 0.2;   ///< of the Chamfer term of samples whose correspondence is known
  double normal_weight = 0.1;    ///< of the term 1 - cos, beside lengths in units of 12 mm
  double spread_weight = 0.02;   ///< of the expected distances' term; it moves nothing but their own layer
  int denoise_queries = 32;      ///< extra queries in training
  double denoise_jitter = 0.05;  ///< standard deviation of their displacement, units of 12 mm
  bool half_precision = true;    ///< bfloat16 for matrix products where the processor has them
};

/// What training came to.
struct CompletionTrainingResult {
  std::uint64_t steps = 0;        ///< optimiser steps since the very start
  std::uint64_t samples = 0;      ///< training samples since the very start
  double last_loss = 0;           ///< total loss of the last step
  double best_root_chamfer = -1;  ///< best validation figure: root Chamfer-L1 in mm; -1: never validated
};

/// Trains the completion network on samples made on the fly, in the loop of `TrainingLoopOptions`: checkpoints and best
/// weights (half precision) go to its folder, which a stopped run goes on from with the same result.
/// The sample provider is called from `threads` threads at once, with numbers below `first_validation_sample` for
/// training and from there on for validation.
/// With weights to start from, the teeth of patches are this run's own: a network learned on other families goes on
/// with these. Reports the loss's terms `coarse_mm`, `match_mm`, `chamfer_mm`, `denoise_mm`, `normal` and `spread`, and
/// the validation figures `tooth_chamfer_l1_mm`, `root_chamfer_l1_mm` (which chooses the best weights),
/// `depth_error_mm` and `normal_error_degrees`; the weights' metadata have these under `validation.`. Throws UsageError
/// for options out of range, InputError for a sample or checkpoint that does not fit and for processes that lose each
/// other, NoResultError where the loss or its gradient is no number.
CompletionTrainingResult train_completion(const CompletionSampleProvider& provider,
                                          const CompletionTrainingOptions& options);

/// The weights of a training folder (`best.safetensors`, or the checkpoint's running mean if it was never
/// validated) as a file for CompletionNetwork::load, in half precision, with `notes` added to its metadata.
/// Throws InputError if the folder has no weights.
TensorFile export_completion(const std::filesystem::path& folder, const std::map<std::string, std::string>& notes);

}  // namespace rhizodont
