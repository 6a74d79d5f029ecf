// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>

namespace rhizodont {

/// Which of several processes this one is.
struct ProcessOptions {
  int count = 1;  ///< >= 1: processes that train one network together; a step takes `batch` samples of each
  int rank = 0;   ///< 0 <= rank < count; the first one, 0, reports, validates and writes the checkpoints
  std::string first_address = "127.0.0.1:29500";  ///< HOST:PORT where the first one listens; all must reach each other
};

/// Throws UsageError for an option out of its range, naming it.
void require_in_range(const ProcessOptions& options);

/// What a training run reports.
enum class TrainingEvent {
  resumed,    ///< it goes on from a checkpoint
  steps,      ///< some steps have been made
  validation  ///< the running mean of the weights has been tried on held-out samples
};

/// How far a training run is, and what the event that it reports has to say.
struct TrainingProgress {
  TrainingEvent event = TrainingEvent::steps;
  std::uint64_t steps = 0;    ///< optimiser steps since the very start
  std::uint64_t samples = 0;  ///< training samples since the very start

  // With `steps`: means over the steps since the last report.
  double loss = 0;                      ///< over the samples of all processes
  std::map<std::string, double> terms;  ///< parts of the loss, over this process's samples; names end in their unit
  double gradient_norm = 0;             ///< before clipping
  double learning_rate = 0;             ///< of the last step
  double samples_per_second = 0;        ///< of all processes; validations and checkpoints do not count

  // With `validation`:
  std::map<std::string, double> validation;  ///< figures; names end in their unit
  bool is_best = false;                      ///< the best so far: these weights are kept
};

/// What the training of any network takes. Defaults that differ from network to network are set by each trainer.
struct TrainingLoopOptions {
  int batch = 16;                   ///< samples per step and process, >= 1
  std::uint64_t samples = 400'000;  ///< length of the learning-rate schedule in samples, >= 1; training stops there
  double hours = 0;                 ///< stop after this time, >= 0; 0: no limit
  double learning_rate = 6e-4;      ///< largest rate, reached after the warm-up, > 0
  double lowest_rate = 0.02;        ///< share of `learning_rate` left at the end of the cosine, 0..1
  int warm_up = 300;                ///< steps of linear warm-up, >= 0
  double weight_decay = 5e-4;       ///< of weight matrices, >= 0; biases, norms and patches have none
  double gradient_clip = 1.0;       ///< largest L2 norm of the gradient, > 0
  double average_decay = 0.998;     ///< of the running mean of the weights that is validated and exported, 0..1
  ProcessOptions processes;
  int threads = 2;                 ///< each works on its share of a batch, >= 1, divides `batch`
  std::uint64_t seed = 1;          ///< of weights and of what is drawn for each sample
  int validation_samples = 64;     ///< held-out samples, >= 0; 0: none
  double validation_minutes = 10;  ///< time between validations, >= 0
  double checkpoint_minutes = 3;   ///< time between checkpoints, >= 0; a stopped run loses at most this
  int report_steps = 50;           ///< steps between reports, >= 1
  std::filesystem::path folder;    ///< where checkpoints and best weights go; empty: none are written
  /// Weights to begin with in place of random ones, as exported; empty: none. Not read where a checkpoint is resumed.
  std::filesystem::path start_from;
  bool resume = false;  ///< go on from the folder's checkpoint, if there is one
  /// Gets each report of the first process, in the thread that trains; may be empty. What it throws ends the training.
  std::function<void(const TrainingProgress&)> progress;
};

/// Throws UsageError for an option out of its range, naming it, and for a batch that threads cannot share evenly.
void require_in_range(const TrainingLoopOptions& options);

/// The rate of step `step`, counted from 0: linear warm-up, then half a cosine from `learning_rate` at the warm-up's
/// end to `lowest_rate` of it where `samples` are reached. Precondition: options in range.
double learning_rate_at(const TrainingLoopOptions& options, std::uint64_t step);

}  // namespace rhizodont
