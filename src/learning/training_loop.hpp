// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Private to this room: brings in torch.

#include <torch/torch.h>

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "learning/process_group.hpp"
#include "learning/training_options.hpp"
#include "networks/safetensors.hpp"

namespace rhizodont {

/// What some samples of a batch come to; means over these samples.
struct TrainingShare {
  std::vector<torch::Tensor> gradients;  ///< of the loss by each parameter, in the network's order; undefined: zero
  double loss = 0;
  std::map<std::string, double> terms;  ///< parts of the loss that are reported
};

/// What a network is worth on held-out samples.
struct Validation {
  double selection = 0;                      ///< >= 0: figure by which the best weights are kept
  std::map<std::string, double> figures;     ///< reported
  std::map<std::string, std::string> notes;  ///< for the metadata of the weights, if they are the best
};

/// What one network brings to the loop that trains any. Functions that may be empty do nothing then. The loop's caller
/// keeps what they refer to alive.
struct TrainingTask {
  /// Metadata by which weights say what network they are of. A checkpoint or weights to start from must have the same.
  std::map<std::string, std::string> identity;
  /// Further metadata of the best weights.
  std::map<std::string, std::string> notes;
  TensorType weight_type = TensorType::float16;  ///< how the best weights are stored
  bool lower_is_better = true;                   ///< which way Validation::selection goes

  /// Before the first step of a run that does not go on from a checkpoint: what the network takes from data. May be
  /// empty.
  std::function<void()> begin;
  /// Before each step, in the thread that trains: samples `first` .. `first + count - 1` come next. May be empty.
  std::function<void(std::uint64_t first, int count)> prepare;
  /// Loss and gradients of samples `first` .. `first + count - 1`. Called from several threads at once, each of which
  /// has one thread for tensors.
  std::function<TrainingShare(std::uint64_t first, int count)> share;
  /// Called while the running mean stands in the place of the weights, without gradients. Not called with
  /// `validation_samples` = 0.
  std::function<Validation()> validate;

  // What a resumed run needs beside weights, optimiser and progress: into a checkpoint, out of one, and from the first
  // process to all others. May be empty.
  std::function<void(TensorFile& checkpoint)> store;
  std::function<void(const TensorFile& checkpoint)> load;
  std::function<void(const ProcessGroup& processes)> hand_round;
};

/// A task of one sample after the other from a pool, its best weights those with the highest figure, kept as floats;
/// with the functions of `training` (prepare, share, validate), which must outlive it.
template <class Training>
TrainingTask task_of(Training& training, std::uint64_t pool) {
  TrainingTask task;
  task.notes["training.pool"] = std::to_string(pool);
  task.weight_type = TensorType::float32;
  task.lower_is_better = false;
  task.prepare = [&](std::uint64_t first, int count) { training.prepare(first, count); };
  task.share = [&](std::uint64_t first, int count) { return training.share(first, count); };
  task.validate = [&] { return training.validate(); };
  return task;
}

/// Adds a sample's gradients to those of a share; the share's are empty before the first. Undefined ones are zero.
void add_gradients(const std::vector<torch::Tensor>& of_sample, std::vector<torch::Tensor>& of_share);

/// Makes means of sums over `count` samples.
void divide_gradients(std::vector<torch::Tensor>& of_share, int count);

/// What a training run came to.
struct TrainingLoopResult {
  std::uint64_t steps = 0;    ///< optimiser steps since the very start
  std::uint64_t samples = 0;  ///< training samples since the very start
  double last_loss = 0;       ///< of the last step; 0 without one
  double best = -1;           ///< best Validation::selection since the very start; -1: never validated
};

/// Trains a network: AdamW with the schedule of learning_rate_at, gradients summed over threads and processes in a
/// fixed order, a running mean of the weights. Writes `checkpoint.safetensors` (everything that is needed to go on: a
/// resumed run gives the same weights as one that was never stopped, if the threads are as many) and, each time the
/// validation improves, `best.safetensors` (the running mean) to `options.folder`. Several processes start from the
/// first one's weights, take different samples and stay equal. The network's parameters must be float; they are changed
/// in place. Throws UsageError for options out of range and for a folder that holds another run's weights, InputError
/// for a checkpoint or weights to start from that do not fit and for processes that lose each other, NoResultError
/// where the loss or its gradient is no number; whatever the task throws.
TrainingLoopResult run_training_loop(const torch::nn::Module& network, const TrainingTask& task,
                                     const TrainingLoopOptions& options);

}  // namespace rhizodont
