// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

#include "learning/training_options.hpp"
#include "networks/labelled_cloud.hpp"
#include "networks/safetensors.hpp"
#include "networks/scan_network.hpp"
#include "training/sample_numbers.hpp"

namespace rhizodont {

/// What the loop takes for the network that finds teeth where nothing else is said.
inline TrainingLoopOptions scan_training_loop() {
  TrainingLoopOptions loop;
  loop.batch = 8;
  loop.samples = 60'000;
  loop.learning_rate = 2e-3;
  loop.warm_up = 100;
  loop.weight_decay = 1e-2;
  loop.average_decay = 0.995;
  loop.threads = 2;
  loop.validation_samples = 40;
  loop.validation_minutes = 6;
  loop.checkpoint_minutes = 3;
  loop.report_steps = 25;
  return loop;
}

/// How much scans differ each time they are seen. Deviations are of normal distributions.
struct ScanVariation {
  double any_turn_share = 0.3;      ///< 0..1: turned about z at random; the others by `turn`
  double turn = 0.15;               ///< rad, >= 0
  double tilt = 0.1;                ///< rad, >= 0
  double strong_tilt_share = 0.25;  ///< 0..1: with three times the tilt
  double size = 0.05;               ///< of the logarithm of the size, and of each axis, >= 0
  double bend = 0.02;               ///< slope of smooth displacements, >= 0
  double crop_share = 0.12;         ///< 0..1: a part of the arch
  double trim_share = 0.5;          ///< 0..1: gum far from teeth is cut off
  double noise_mm = 0.03;           ///< >= 0
};

/// Settings of `train_scan`.
struct ScanTrainingOptions {
  ScanShape shape;
  TrainingLoopOptions loop = scan_training_loop();
  std::uint64_t pool = 600;  ///< different scans, >= 1: afterwards they come again, varied otherwise
  ScanVariation variation;
};

/// How well a network reads scans, over all points of their finest level.
struct ScanFigures {
  double loss = 0;
  double accuracy = 0;   ///< share of points whose kind is right
  double tooth_gum = 0;  ///< share of points that are rightly tooth or gum
  double jaw = 0;        ///< share of scans whose jaw is right
  double offset_mm = 0;  ///< mean distance of the middles that tooth points are drawn to from the true ones
  double turn_deg = 0;   ///< mean angle between the front direction and the true one
};

struct ScanTrainingResult {
  std::uint64_t steps = 0, samples = 0;  ///< since the very start
  ScanFigures best;                      ///< of this run's validation with the largest accuracy
};

/// Trains the network that finds teeth (networks/scan_network.hpp): cross entropy of the kinds and borders, distances
/// of offsets and directions. In the loop of `TrainingLoopOptions`, as `train_surface`. The provider is called with
/// numbers below `pool` and, for validation, from `first_validation_sample` on; each is called for once and kept.
/// Throws as train_surface.
ScanTrainingResult train_scan(const CloudProvider& provider, const ScanTrainingOptions& options);

/// The weights of a training folder as a file for ScanNetwork::load, with `notes` added to its metadata.
/// Throws InputError if the folder has no weights.
TensorFile export_scan(const std::filesystem::path& folder, const std::map<std::string, std::string>& notes);

}  // namespace rhizodont
