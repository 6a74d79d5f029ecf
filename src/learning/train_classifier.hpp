// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "networks/safetensors.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace rhizodont {

/// Panoramas with what they show: `channels` maps of rows x columns each (distance, hit, normal along the ray, along
/// the columns, along the rows; 0 where nothing is hit), columns wrapping around.
struct LabelledPanoramas {
  std::size_t channels = 5, rows = 24, columns = 64;
  std::vector<float> values;         ///< panorama by panorama, channel by channel, row by row
  std::vector<std::int32_t> labels;  ///< one per panorama: pairs 2k, 2k + 1 are mirror images; the last is its own
};

/// Settings of `train_classifier`.
struct ClassifierTrainingOptions {
  int steps = 4000;                             ///< >= 10
  int batch = 96;                               ///< panoramas per step, >= 2
  double learning_rate = 2.5e-3;                ///< largest rate, reached after a third of the steps, > 0
  double weight_decay = 0.02;                   ///< >= 0
  double label_smoothing = 0.02;                ///< 0..1
  double dropout = 0.2;                         ///< of what the last two layers see, 0..1
  int width = 16;                               ///< channels of the first layer, 1..256
  int classes = 33;                             ///< odd, >= 3
  int threads = 1;                              ///< >= 1
  std::uint64_t seed = 1;                       ///< of weights, batches and variations
  std::function<void(const std::string&)> log;  ///< gets a line now and then; may be empty
};

/// Trains a convolutional network on panoramas: AdamW (Loshchilov, Hutter, 2019) with one cycle of the learning rate
/// (L. N. Smith, N. Topin, "Super-convergence", 2018), batch normalisation folded into the weights that it returns.
/// Each panorama comes turned, mirrored half of the time, scaled, with noise and with places missing.
/// Throws UsageError for options out of range or arrays that do not fit, NoResultError where the loss is no number.
TensorFile train_classifier(const LabelledPanoramas& samples, const ClassifierTrainingOptions& options);

}  // namespace rhizodont
