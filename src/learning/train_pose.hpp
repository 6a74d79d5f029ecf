// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "learning/training_options.hpp"
#include "networks/safetensors.hpp"
#include "training/labelled_panoramas.hpp"

#include <cstdint>
#include <functional>

namespace rhizodont {

/// Settings of `train_pose`.
struct PoseTrainingOptions {
  int steps = 4000;               ///< >= 10
  int batch = 96;                 ///< panoramas per step, >= 2
  double learning_rate = 2.5e-3;  ///< largest rate, reached after a third of the steps, > 0
  double weight_decay = 0.02;     ///< >= 0
  double lean_weight = 10;        ///< of the lean's error (as sines of angles) beside the turn's likelihood, > 0
  int width = 16;                 ///< channels of the first layer, 1..256
  int threads = 1;                ///< >= 1
  std::uint64_t seed = 1;         ///< of weights, batches and variations
  int report_steps = 100;         ///< steps between reports, >= 1; the last step is reported too
  /// Gets a report now and then, its loss being a running mean; may be empty. What it throws ends the training.
  std::function<void(const TrainingProgress&)> progress = {};
};

/// Throws UsageError for an option out of its range, naming it.
void require_in_range(const PoseTrainingOptions& options);

/// Trains the network that tells how crowns stand (PoseNetwork) by the likelihood of the cheek's direction and the
/// lean's mean absolute error, smoothed near zero (Huber). Else as `train_classifier`, but that nothing is mirrored.
/// Throws UsageError for options out of range or arrays that do not fit, NoResultError where the loss is no number.
TensorFile train_pose(const PosedPanoramas& samples, const PoseTrainingOptions& options);

}  // namespace rhizodont
