// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "learning/training_options.hpp"
#include "networks/safetensors.hpp"
#include "training/labelled_panoramas.hpp"

#include <cstdint>
#include <functional>

namespace rhizodont {

/// Settings of `train_classifier`.
struct ClassifierTrainingOptions {
  int steps = 4000;                ///< >= 10
  int batch = 96;                  ///< panoramas per step, >= 2
  double learning_rate = 2.5e-3;   ///< largest rate, reached after a third of the steps, > 0
  double weight_decay = 0.02;      ///< >= 0
  double label_smoothing = 0.005;  ///< 0..1
  double dropout = 0.2;            ///< of what the last two layers see, 0..1
  int width = 16;                  ///< channels of the first layer, 1..256
  int classes = 33;                ///< odd, >= 3
  int threads = 1;                 ///< >= 1
  std::uint64_t seed = 1;          ///< of weights, batches and variations
  int report_steps = 100;          ///< steps between reports, >= 1; the last step is reported too
  /// Gets a report now and then, its loss being a running mean; may be empty. What it throws ends the training.
  std::function<void(const TrainingProgress&)> progress;
};

/// Throws UsageError for an option out of its range, naming it.
void require_in_range(const ClassifierTrainingOptions& options);

/// Trains a convolutional network on panoramas: AdamW (Loshchilov, Hutter, 2019) with one cycle of the learning rate
/// (L. N. Smith, N. Topin, "Super-convergence", 2018), batch normalisation folded into the weights that it returns.
/// Each panorama comes turned, mirrored half of the time, scaled, with noise and with places missing.
/// Beside the loop of the other trainers: batch normalisation has state that is no parameter, and a few minutes of
/// training need no checkpoints.
/// Throws UsageError for options out of range or arrays that do not fit, NoResultError where the loss is no number.
TensorFile train_classifier(const LabelledPanoramas& samples, const ClassifierTrainingOptions& options);

}  // namespace rhizodont
