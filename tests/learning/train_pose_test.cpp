// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "learning/train_pose.hpp"

#include "completion/pose_network.hpp"
#include "rhizodont/error.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace rhizodont {
namespace {

/// Distances with one broad bump where the cheek is; the form leans away from it, as far as the bump is high.
PosedPanoramas bumps(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  PosedPanoramas all;
  LabelledPanoramas& of = all.panoramas;
  for (std::size_t i = 0; i < count; ++i) {
    const double azimuth = 2 * std::numbers::pi * uniform(random), height = 0.2 + 0.6 * uniform(random);
    for (std::size_t k = 0; k < of.channels; ++k)
      for (std::size_t r = 0; r < of.rows; ++r)
        for (std::size_t c = 0; c < of.columns; ++c) {
          const double at = (static_cast<double>(c) + 0.5) * 2 * std::numbers::pi / static_cast<double>(of.columns);
          const double distance = 1 + height * std::exp(3 * (std::cos(at - azimuth) - 1));
          of.values.push_back(k == 0 ? static_cast<float>(distance) : k == 1 ? 1.0F : k == 2 ? 0.9F : 0.0F);
        }
    of.labels.push_back(static_cast<std::int32_t>(i % 16));
    all.azimuths.push_back(static_cast<float>(azimuth));
    for (const double part : {std::cos(azimuth), std::sin(azimuth)})
      all.leans.push_back(static_cast<float>(-0.5 * height * part));
  }
  return all;
}

PoseTrainingOptions quick_pose() {
  PoseTrainingOptions options;
  options.steps = 250;
  options.batch = 24;
  options.width = 4;
  return options;
}

TEST(TrainPose, LearnsWhereTheCheekIsAndHowTheFormLeans) {
  const PoseNetwork network(train_pose(bumps(200, 1), quick_pose()));
  const PosedPanoramas others = bumps(40, 2);
  const std::size_t each = others.panoramas.values.size() / others.azimuths.size();
  double turn = 0, lean = 0, no_lean = 0;
  for (std::size_t i = 0; i < others.azimuths.size(); ++i) {
    const auto begin = others.panoramas.values.begin() + static_cast<std::ptrdiff_t>(i * each);
    const PanoramaPose said = network({{begin, begin + static_cast<std::ptrdiff_t>(each)}}, others.panoramas.labels[i]);
    turn += std::abs(std::remainder(said.azimuth - static_cast<double>(others.azimuths[i]), 2 * std::numbers::pi)) / 40;
    const Eigen::Vector2d truth(static_cast<double>(others.leans[2 * i]), static_cast<double>(others.leans[2 * i + 1]));
    lean += (said.form_axis - truth).norm() / 40, no_lean += truth.norm() / 40;
  }
  EXPECT_LT(turn, 0.15) << "radians; by chance 1.57";
  EXPECT_LT(lean, 0.4 * no_lean);
}

TEST(TrainPose, TheSameSeedGivesTheSameWeights) {
  PoseTrainingOptions options = quick_pose();
  options.steps = 10;
  const std::string one = safetensors_bytes(train_pose(bumps(32, 1), options));
  EXPECT_EQ(one, safetensors_bytes(train_pose(bumps(32, 1), options)));
  options.seed = 2;
  EXPECT_NE(one, safetensors_bytes(train_pose(bumps(32, 1), options)));
}

TEST(TrainPose, WrongOptionsAndArraysAreRefused) {
  const auto refused = [](const auto& change) {
    PoseTrainingOptions options = quick_pose();
    PosedPanoramas samples = bumps(6, 1);
    change(options, samples);
    EXPECT_THROW(train_pose(samples, options), UsageError);
  };
  refused([](auto& o, auto&) { o.steps = 9; });
  refused([](auto& o, auto&) { o.batch = 1; });
  refused([](auto& o, auto&) { o.lean_weight = 0; });
  refused([](auto& o, auto&) { o.width = 0; });
  refused([](auto&, auto& s) { s.panoramas.labels[2] = 16; });
  refused([](auto&, auto& s) { s.azimuths.pop_back(); });
  refused([](auto&, auto& s) { s.leans.pop_back(); });
}

}  // namespace
}  // namespace rhizodont
