// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>

#include "learning/training_sample.hpp"
#include "networks/completion_shape.hpp"
#include "networks/safetensors.hpp"

namespace rhizodont {

/// Which of several processes this one is.
struct ProcessOptions {
  int count = 1;  ///< >= 1: processes that train one network together; a step takes `batch` samples of each
  int rank = 0;   ///< 0 <= rank < count; the first one, 0, keeps the log, validates and writes the checkpoints
  std::string first_address = "127.0.0.1:29500";  ///< HOST:PORT where the first one listens; all must reach each other
};

/// Throws UsageError for an option out of its range.
void require_in_range(const ProcessOptions& options);

/// Settings of `train_completion`.
struct TrainingOptions {
  CompletionShape shape;
  int batch = 16;                   ///< samples per step, >= 1
  std::uint64_t samples = 400'000;  ///< length of the learning-rate schedule in samples; training stops there
  double hours = 0;                 ///< stop after this time, 0: no limit
  double learning_rate = 6e-4;      ///< largest rate, reached after the warm-up
  double lowest_rate = 0.02;        ///< share of `learning_rate` left at the end of the cosine, 0..1
  int warm_up = 300;                ///< steps of linear warm-up, >= 0
  double weight_decay = 5e-4;       ///< of weight matrices; biases, norms and patches have none
  double gradient_clip = 1.0;       ///< largest L2 norm of the gradient
  double average_decay = 0.998;     ///< of the running mean of the weights that is validated and exported, 0..1
  double unknown_share = 0.1;       ///< share of samples whose type is hidden, 0..1
  double root_weight = 3;           ///< weight of target points below the crown beside those on it, > 0
  double coarse_weight = 0.5;       ///< of the queries' starting points
  double denoise_weight = 0.5;      ///< of the denoising queries
  double chamfer_weight = 0.2;      ///< of the Chamfer term of samples whose correspondence is known, >= 0
  double normal_weight = 0.1;       ///< of the term 1 - cos, beside lengths in units of 12 mm
  double spread_weight = 0.02;      ///< of the expected distances' term; it moves nothing but their own layer
  int denoise_queries = 32;         ///< extra queries in training, >= 0
  double denoise_jitter = 0.05;     ///< standard deviation of their displacement, units of 12 mm
  bool half_precision = true;       ///< bfloat16 for matrix products where the processor has them
  ProcessOptions processes;
  int threads = 2;                 ///< each works on its share of a batch, >= 1, divides `batch`
  std::uint64_t seed = 1;          ///< of weights, noise and sample numbers
  int validation_samples = 64;     ///< held-out samples, numbers that training never reaches; 0: none
  double validation_minutes = 10;  ///< time between validations
  double checkpoint_minutes = 3;   ///< time between checkpoints; a stopped run loses at most this
  int log_steps = 50;              ///< steps between log lines, >= 1
  std::filesystem::path folder;    ///< where checkpoints go; empty: none are written
  /// Weights to begin with in place of random ones, as exported; empty: none. The teeth of patches are this run's own:
  /// a network learned on other families goes on with these. Not read where a checkpoint is resumed.
  std::filesystem::path start_from;
  bool resume = false;                          ///< go on from the folder's checkpoint, if there is one
  std::function<void(const std::string&)> log;  ///< gets each line; may be empty
};

/// What training came to.
struct TrainingResult {
  std::uint64_t steps = 0;        ///< optimiser steps since the very start
  std::uint64_t samples = 0;      ///< training samples since the very start
  double last_loss = 0;           ///< total loss of the last step
  double best_root_chamfer = -1;  ///< best validation figure: root Chamfer-L1 in mm; -1: never validated
};

/// Trains the completion network on samples made on the fly. Writes `checkpoint.safetensors` (everything that is needed
/// to go on: a resumed run gives the same weights as one that was never stopped, if the threads are as many) and, each
/// time the validation figure improves, `best.safetensors` (running mean of the weights, half precision) to
/// `options.folder`.
/// The sample provider is called from `threads` threads at once, with numbers below `first_validation_sample` for
/// training and from there on for validation.
/// Several processes (`options.processes`) start from the first one's checkpoint or weights, take different samples and
/// sum their gradients, so that their weights stay the same.
/// Throws UsageError for options out of range, InputError for a sample or checkpoint that does not fit and for
/// processes that lose each other.
TrainingResult train_completion(const SampleProvider& provider, const TrainingOptions& options);

/// The weights of a training folder (`best.safetensors`, or the checkpoint's running mean if it was never
/// validated) as a file for CompletionNetwork::load, in half precision, with `notes` added to its metadata.
/// Throws InputError if the folder has no weights.
TensorFile export_completion(const std::filesystem::path& folder, const std::map<std::string, std::string>& notes);

}  // namespace rhizodont
