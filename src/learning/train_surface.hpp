// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

#include "learning/training_options.hpp"
#include "networks/safetensors.hpp"
#include "networks/surface_network.hpp"
#include "networks/surface_sample.hpp"
#include "training/sample_numbers.hpp"

namespace rhizodont {

/// What the loop takes for surface networks where nothing else is said.
inline TrainingLoopOptions surface_training_loop() {
  TrainingLoopOptions loop;
  loop.batch = 4;
  loop.samples = 60'000;
  loop.learning_rate = 2e-3;
  loop.warm_up = 100;
  loop.weight_decay = 1e-3;
  loop.average_decay = 0.995;
  loop.threads = 1;
  loop.validation_samples = 100;
  loop.validation_minutes = 8;
  loop.checkpoint_minutes = 2;
  return loop;
}

/// Settings of `train_surface`.
struct SurfaceTrainingOptions {
  SurfaceShape shape;
  TrainingLoopOptions loop = surface_training_loop();
  std::uint64_t pool = 3'000;     ///< different samples, >= 1: afterwards they come again, turned otherwise
  double tilt_radians = 0.08;     ///< standard deviation of the tilt of positions and normals, >= 0; about z any turn
  double scale_deviation = 0.04;  ///< of the logarithm of the positions' scale, >= 0
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

/// Trains a surface network on labelled samples: cross entropy, each vertex weighted by its area; in the loop of
/// `TrainingLoopOptions`: checkpoints and best weights (single precision) go to its folder, which a stopped run goes on
/// from with the same result. The provider is called from several threads, ahead of need, with numbers below `pool`
/// and, for validation, from `first_validation_sample` on. Reports the validation figures `loss`, `accuracy` and
/// `intersection_over_union`, which chooses the best weights.
/// Throws UsageError for options out of range, InputError for a sample or checkpoint that does not fit and for
/// processes that lose each other, NoResultError where the loss or its gradient is no number.
SurfaceTrainingResult train_surface(const SurfaceProvider& provider, const SurfaceTrainingOptions& options);

/// The figures of a network on samples `first` .. `first + count - 1`.
SurfaceFigures measure_surface(const SurfaceNetwork& network, const SurfaceProvider& provider, std::uint64_t first,
                               std::uint64_t count);

/// The weights of a training folder as a file for SurfaceNetwork::load, with `notes` added to its metadata.
/// Throws InputError if the folder has no weights.
TensorFile export_surface(const std::filesystem::path& folder, const std::map<std::string, std::string>& notes);

}  // namespace rhizodont
