// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

namespace rhizodont {

/// A stream of random numbers that is the same on every machine and compiler (the standard library's distributions are
/// not). SplitMix64: G. L. Steele, D. Lea, C. H. Flood, "Fast splittable pseudorandom number generators", 2014.
class RandomStream {
 public:
  /// Streams of different seeds, or of different purposes under one seed, are independent for our needs.
  explicit RandomStream(std::uint64_t seed, std::uint64_t purpose = 0)
      : state_(mix(seed + 0x9e3779b97f4a7c15ULL) ^ mix(purpose * 0xd1342543de82ef95ULL + 0x632be59bd9b4e019ULL)) {}

  std::uint64_t bits() { return mix(state_ += 0x9e3779b97f4a7c15ULL); }
  /// In [0, 1).
  double uniform() { return static_cast<double>(bits() >> 11) * 0x1.0p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  bool chance(double probability) { return uniform() < probability; }
  /// In [0, count).
  std::uint64_t index(std::uint64_t count) { return bits() % count; }
  /// Standard normal (Box and Muller).
  double normal() {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
    return radius * std::cos(2.0 * std::numbers::pi * uniform());
  }
  /// Normal, cut off at `limit` standard deviations.
  double normal(double mean, double deviation, double limit = 2.3) {
    double value = normal();
    while (std::abs(value) > limit) value = normal();
    return mean + deviation * value;
  }

 private:
  static std::uint64_t mix(std::uint64_t x) {
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
    return x ^ (x >> 31);
  }

  std::uint64_t state_;
};

}  // namespace rhizodont
