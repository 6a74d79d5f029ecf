// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "learning/train_classifier.hpp"

#include "completion/tooth_classifier.hpp"
#include "rhizodont/error.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace rhizodont {
namespace {

/// Ramps around the axis that rise one way (0), the other way (1), or not at all (the last label).
LabelledPanoramas ramps(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(0, 1);
  LabelledPanoramas all;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t kind = i % 3;
    const float offset = uniform(random), height = 0.5F + uniform(random);
    for (std::size_t k = 0; k < all.channels; ++k)
      for (std::size_t r = 0; r < all.rows; ++r)
        for (std::size_t c = 0; c < all.columns; ++c) {
          float turn = std::fmod(static_cast<float>(c) / static_cast<float>(all.columns) + offset, 1.0F);
          if (kind == 1) turn = 1 - turn;
          if (kind == 2) turn = 0.5F;
          all.values.push_back(k == 0 ? 1 + height * turn : k == 1 ? 1.0F : k == 2 ? 0.9F : 0.0F);
        }
    all.labels.push_back(kind == 2 ? 32 : static_cast<std::int32_t>(kind));
  }
  return all;
}

ClassifierTrainingOptions quick() {
  ClassifierTrainingOptions options;
  options.steps = 60;
  options.batch = 24;
  options.width = 4;
  return options;
}

TEST(TrainClassifier, LearnsWhatDiffers) {
  const ToothClassifier classifier(train_classifier(ramps(90, 1), quick()));
  const LabelledPanoramas others = ramps(30, 2);
  const std::size_t each = others.values.size() / others.labels.size();
  int right = 0;
  for (std::size_t i = 0; i < others.labels.size(); ++i) {
    const auto begin = others.values.begin() + static_cast<std::ptrdiff_t>(i * each);
    const ToothProbabilities said = classifier({{begin, begin + static_cast<std::ptrdiff_t>(each)}});
    const auto is = static_cast<std::size_t>(others.labels[i]);
    const double own = is == 32 ? said.log_unlike : said.log_tooth[is];
    right += own > std::log(0.5) ? 1 : 0;
  }
  EXPECT_GE(right, 27) << "of 30";
}

TEST(TrainClassifier, TheSameSeedGivesTheSameWeights) {
  ClassifierTrainingOptions options = quick();
  options.steps = 10;
  const std::string one = safetensors_bytes(train_classifier(ramps(30, 1), options));
  EXPECT_EQ(one, safetensors_bytes(train_classifier(ramps(30, 1), options)));
  options.seed = 2;
  EXPECT_NE(one, safetensors_bytes(train_classifier(ramps(30, 1), options)));
}

TEST(TrainClassifier, WrongOptionsAndArraysAreRefused) {
  const auto refused = [](const auto& change) {
    ClassifierTrainingOptions options = quick();
    LabelledPanoramas samples = ramps(6, 1);
    change(options, samples);
    EXPECT_THROW(train_classifier(samples, options), UsageError);
  };
  refused([](auto& o, auto&) { o.steps = 9; });
  refused([](auto& o, auto&) { o.batch = 1; });
  refused([](auto& o, auto&) { o.learning_rate = 0; });
  refused([](auto& o, auto&) { o.dropout = 1; });
  refused([](auto& o, auto&) { o.width = 0; });
  refused([](auto& o, auto&) { o.classes = 32; });
  refused([](auto& o, auto&) { o.threads = 0; });
  refused([](auto&, auto& s) { s.labels[2] = 33; });
  refused([](auto&, auto& s) { s.labels.pop_back(); });
  refused([](auto&, auto& s) { s.rows = 23; });
}

}  // namespace
}  // namespace rhizodont
