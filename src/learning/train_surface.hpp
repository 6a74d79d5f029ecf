// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>

#include "networks/safetensors.hpp"
#include "networks/surface_network.hpp"
#include "networks/surface_sample.hpp"

namespace rhizodont {

/// Settings of `train_surface`.
struct SurfaceTrainingOptions {
  SurfaceShape shape;
  int batch = 4;                   ///< samples per step, >= 1
  std::uint64_t samples = 60'000;  ///< length of the learning-rate schedule in samples; training stops there
  std::uint64_t pool = 3'000;      ///< different samples, >= 1: afterwards they come again, turned otherwise
  double hours = 0;                ///< stop after this time, 0: no limit
  double learning_rate = 2e-3;     ///< largest rate, reached after the warm-up
  double lowest_rate = 0.02;       ///< share of it left at the end of the cosine, 0..1
  int warm_up = 100;               ///< steps of linear warm-up, >= 0
  double weight_decay = 1e-3;      ///< of weight matrices
  double gradient_clip = 1.0;      ///< largest L2 norm of the gradient
  double average_decay = 0.995;    ///< of the running mean of the weights that is validated and exported, 0..1
  double tilt_radians = 0.08;      ///< standard deviation of the tilt of positions and normals, >= 0; about z any turn
  double scale_deviation = 0.04;   ///< of the logarithm of the positions' scale, >= 0
  int threads = 1;                 ///< each works on its share of a batch, >= 1, divides `batch`
  std::uint64_t seed = 1;          ///< of weights and turns
  int validation_samples = 100;    ///< held-out samples, numbers that training never reaches; 0: none
  double validation_minutes = 8;   ///< time between validations
  double checkpoint_minutes = 2;   ///< time between checkpoints; a stopped run loses at most this
  int log_steps = 50;              ///< steps between log lines, >= 1
  std::filesystem::path folder;    ///< where checkpoints go; empty: none are written
  bool resume = false;             ///< go on from the folder's checkpoint, if there is one
  std::function<void(const std::string&)> log;  ///< gets each line; may be empty
};

/// How well a network tells label 1 from label 0, at a threshold of 0.5 and over all vertices of all samples.
struct SurfaceFigures {
  double loss = 0;          ///< mean cross entropy, by area
  double accuracy = 0;      ///< share of vertices that are right
  double intersection = 1;  ///< intersection over union of the vertices with label 0; 1 if there are none
  std::uint64_t vertices = 0;
};

/// What training came to.
struct SurfaceTrainingResult {
  std::uint64_t steps = 0, samples = 0;  ///< since the very start
  double last_loss = 0;
  SurfaceFigures best;  ///< of the validation with the largest intersection over union
};

/// Trains a surface network on labelled samples: cross entropy, each vertex weighted by its area. Writes
/// `checkpoint.safetensors` (a resumed run gives the same weights as one that was never stopped) and, each time the
/// validation improves, `best.safetensors` (running mean of the weights) to `options.folder`. The provider is called
/// from several threads, ahead of need, with numbers below `pool` and, for validation, from `first_validation_sample`
/// on. Throws UsageError for options out of range, InputError for a sample or checkpoint that does not fit.
SurfaceTrainingResult train_surface(const SurfaceProvider& provider, const SurfaceTrainingOptions& options);

/// The figures of a network on samples `first` .. `first + count - 1`.
SurfaceFigures measure_surface(const SurfaceNetwork& network, const SurfaceProvider& provider, std::uint64_t first,
                               std::uint64_t count);

/// The weights of a training folder as a file for SurfaceNetwork::load, with `notes` added to its metadata.
/// Throws InputError if the folder has no weights.
TensorFile export_surface(const std::filesystem::path& folder, const std::map<std::string, std::string>& notes);

}  // namespace rhizodont
