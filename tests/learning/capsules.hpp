// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "learning/train_completion.hpp"
#include "training/completion_training_sample.hpp"

namespace rhizodont::testing {

/// A bent tube as a stand-in for a tooth: its upper part is the crown. Type and shape follow from the number.
inline CompletionTrainingSample capsule(std::uint64_t number, int input_points, int target_points) {
  std::mt19937_64 random(1000 + number);
  std::uniform_real_distribution<float> uniform(0, 1);
  CompletionTrainingSample sample;
  sample.type = static_cast<int>(number % tooth_types);
  const float length = 0.7F + 0.3F * uniform(random) + 0.02F * static_cast<float>(sample.type);
  const float radius = 0.25F + 0.1F * uniform(random), bend = 0.3F * (uniform(random) - 0.5F), neck = -0.2F;
  const auto add = [&](float lowest, Eigen::Vector3f& p, Eigen::Vector3f& normal) {
    p.z() = lowest + (0.35F - lowest) * uniform(random);
    const float angle = 2 * std::numbers::pi_v<float> * uniform(random);
    const float shift = p.z() < 0 ? bend * p.z() * p.z() : 0;
    normal = {std::cos(angle), std::sin(angle), 0};
    p.x() = shift + radius * normal.x();
    p.y() = radius * normal.y();
  };
  Eigen::Vector3f p, normal;
  for (int i = 0; i < input_points; ++i) {
    add(neck, p, normal);
    sample.input.push_back(p);
  }
  for (int i = 0; i < target_points; ++i) {
    add(-length, p, normal);
    sample.target.push_back(p);
    sample.normals.push_back(normal);
    sample.is_root.push_back(p.z() < neck ? 1 : 0);
  }
  return sample;
}

/// The same with corresponding points: each has its own height and angle on the tube. Numbers below `matched_types` in
/// type have them, all others stand for types without.
inline CompletionTrainingSample matched_capsule(std::uint64_t number, int input_points, int target_points,
                                                int matched_types = 8) {
  CompletionTrainingSample sample = capsule(number, input_points, target_points);
  if (sample.type >= matched_types) return sample;
  float lowest = 0;
  Eigen::Vector3f middle = Eigen::Vector3f::Zero();
  for (const Eigen::Vector3f& p : sample.target) lowest = std::min(lowest, p.z());
  for (std::size_t i = 0; i < sample.target.size(); ++i)
    middle += sample.target[i] / static_cast<float>(sample.target.size());
  constexpr int rows = 20, columns = 8;
  for (int i = 0; i < rows * columns; ++i) {
    const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(i % columns) / columns;
    const float share = static_cast<float>(i / columns) / (rows - 1);
    const Eigen::Vector3f normal(std::cos(angle), std::sin(angle), 0);
    sample.matched.emplace_back(0.3F * normal.x() + middle.x(), 0.3F * normal.y(),
                                lowest * share + 0.35F * (1 - share));
    sample.matched_normals.push_back(normal);
    sample.matched_root.push_back(share > 0.4F ? 1 : 0);
  }
  return sample;
}

/// A network small enough for tests.
inline CompletionShape tiny_shape() {
  CompletionShape shape;
  shape.input_points = 64;
  shape.centres_1 = 32;
  shape.centres_2 = 16;
  shape.width = 32;
  shape.heads = 2;
  shape.encoder_depth = 2;
  shape.decoder_depth = 2;
  shape.global_width = 48;
  shape.queries = 24;
  shape.patch_points = 4;
  return shape;
}

inline CompletionTrainingOptions tiny_options() {
  CompletionTrainingOptions options;
  options.shape = tiny_shape();
  options.loop.batch = 4;
  options.loop.samples = 40;
  options.loop.warm_up = 2;
  options.denoise_queries = 8;
  options.half_precision = false;
  options.loop.validation_samples = 0;
  return options;
}

inline CompletionTrainingSample tiny_sample(std::uint64_t number) { return matched_capsule(number, 64, 128); }

}  // namespace rhizodont::testing
