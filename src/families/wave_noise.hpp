// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "base/random_stream.hpp"

#include <Eigen/Core>

#include <array>
#include <cmath>
#include <numbers>

namespace rhizodont {

/// A smooth random function of the place, mean 0, standard deviation about 1: plane waves of random directions.
class WaveNoise {
 public:
  /// Waves between `shortest` and `longest` mm.
  WaveNoise(RandomStream& random, double shortest, double longest) {
    for (Wave& wave : waves_) {
      const double z = random.uniform(-1, 1), turn = random.uniform(0, 2 * std::numbers::pi);
      const double level = std::sqrt(1 - z * z);
      const double length = shortest * std::pow(longest / shortest, random.uniform());
      wave.direction =
          2 * std::numbers::pi / length * Eigen::Vector3d(level * std::cos(turn), level * std::sin(turn), z);
      wave.phase = random.uniform(0, 2 * std::numbers::pi);
    }
  }

  double operator()(const Eigen::Vector3d& p) const {
    double sum = 0;
    for (const Wave& wave : waves_) sum += std::sin(wave.direction.dot(p) + wave.phase);
    return sum * std::sqrt(2.0 / static_cast<double>(waves_.size()));
  }

 private:
  struct Wave {
    Eigen::Vector3d direction;
    double phase = 0;
  };
  std::array<Wave, 7> waves_;
};

}  // namespace rhizodont
