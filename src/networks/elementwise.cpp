// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// Exponential: argument reduced to |r| <= ln 2 / 2 (W. J. Cody, W. Waite, Software Manual for the Elementary Functions,
// 1980), then the exponential series. Error function: M. Abramowitz, I. Stegun, Handbook of Mathematical
// Functions, 7.1.26.
#include "networks/elementwise.hpp"

#include <bit>
#include <cmath>
#include <cstdint>

namespace rhizodont::networks {
namespace {

// Loops over plain numbers: the compiler makes vectors of them, as wide as each clone's processor has them.

inline float exponential(float x) {
  constexpr float lowest = -87.0F, highest = 88.0F;
  constexpr float per_octave = 1.44269504F, octave_high = 0.693359375F, octave_low = -2.12194440e-4F;
  constexpr float rounding = 12582912.0F;  // 1.5 2^23: adding it leaves a whole number in the last bits
  x = lowest > x ? lowest : x;             // this way round, what is not a number stays so
  x = highest < x ? highest : x;
  const float shifted = x * per_octave + rounding;
  const float octaves = shifted - rounding;
  const float r = (x - octaves * octave_high) - octaves * octave_low;
  float sum = 1.0F / 5040;
  sum = sum * r + 1.0F / 720;
  sum = sum * r + 1.0F / 120;
  sum = sum * r + 1.0F / 24;
  sum = sum * r + 1.0F / 6;
  sum = sum * r + 0.5F;
  sum = sum * r + 1.0F;
  sum = sum * r + 1.0F;
  const std::int32_t exponent = std::bit_cast<std::int32_t>(shifted) - std::bit_cast<std::int32_t>(rounding) + 127;
  return sum * std::bit_cast<float>(exponent << 23);
}

/// exp(-x x) times a polynomial: 1 - erf(x) for x >= 0.
inline float complementary_error(float x) {
  const float t = 1.0F / (1.0F + 0.3275911F * x);
  float sum = 1.061405429F;
  sum = sum * t - 1.453152027F;
  sum = sum * t + 1.421413741F;
  sum = sum * t - 0.284496736F;
  sum = sum * t + 0.254829592F;
  return sum * t * exponential(-x * x);
}

[[gnu::target_clones("avx512f", "avx2", "default")]] void gelu_of(float* values, Eigen::Index count) {
  for (Eigen::Index i = 0; i < count; ++i) {
    const float x = values[i], size = std::abs(x);
    // x / 2 (1 + erf) is x less x / 2 (1 - erf) where x is positive, and x / 2 (1 - erf |x|) where it is not.
    const float rest = 0.5F * size * complementary_error(0.707106781F * size);
    values[i] = (x > 0 ? x : 0.0F) - rest;
  }
}

[[gnu::target_clones("avx512f", "avx2", "default")]] void tanh_of(float* values, Eigen::Index count) {
  for (Eigen::Index i = 0; i < count; ++i)
    values[i] = std::copysign(1.0F - 2.0F / (exponential(2.0F * std::abs(values[i])) + 1.0F), values[i]);
}

[[gnu::target_clones("avx512f", "avx2", "default")]] void exponentials_of(float* values, Eigen::Index count,
                                                                          float greatest) {
  for (Eigen::Index i = 0; i < count; ++i) values[i] = exponential(values[i] - greatest);
}

[[gnu::target_clones("avx512f", "avx2", "default")]] void scale_negatives(float* values, Eigen::Index count,
                                                                          float factor) {
  for (Eigen::Index i = 0; i < count; ++i) values[i] = values[i] < 0 ? factor * values[i] : values[i];
}

[[gnu::target_clones("avx512f", "avx2", "default")]] void drop_negatives(float* values, Eigen::Index count) {
  for (Eigen::Index i = 0; i < count; ++i) values[i] = values[i] < 0 ? 0.0F : values[i];
}

// Sums and the like over eight lanes, then over the lanes, then over the rest: one order for all processors.
constexpr Eigen::Index lanes = 8;
using Floats = float __attribute__((vector_size(lanes * sizeof(float))));
using FloatsInMemory = float __attribute__((vector_size(lanes * sizeof(float)), aligned(alignof(float)), may_alias));

[[gnu::target_clones("avx2", "default")]] float largest_of(const float* values, Eigen::Index count) {
  Floats most = Floats{} + values[0];
  Eigen::Index i = 0;
  for (; i + lanes <= count; i += lanes) {
    const Floats x = *reinterpret_cast<const FloatsInMemory*>(values + i);
    most = x > most ? x : most;
  }
  float result = most[0];
  for (Eigen::Index lane = 1; lane < lanes; ++lane) result = std::max(result, most[lane]);
  for (; i < count; ++i) result = std::max(result, values[i]);
  return result;
}

[[gnu::target_clones("avx2", "default")]] float sum_of(const float* values, Eigen::Index count) {
  Floats sums{};
  Eigen::Index i = 0;
  for (; i + lanes <= count; i += lanes) sums += *reinterpret_cast<const FloatsInMemory*>(values + i);
  float result = 0;
  for (Eigen::Index lane = 0; lane < lanes; ++lane) result += sums[lane];
  for (; i < count; ++i) result += values[i];
  return result;
}

[[gnu::target_clones("avx2", "default")]] float squares_of(const float* values, Eigen::Index count) {
  Floats sums{};
  Eigen::Index i = 0;
  for (; i + lanes <= count; i += lanes) {
    const Floats x = *reinterpret_cast<const FloatsInMemory*>(values + i);
    sums += x * x;
  }
  float result = 0;
  for (Eigen::Index lane = 0; lane < lanes; ++lane) result += sums[lane];
  for (; i < count; ++i) result += values[i] * values[i];
  return result;
}

template <typename Work>
void each_row(MatrixSpan& values, const Work& work) {
  for (Eigen::Index r = 0; r < values.rows(); ++r) work(values.data() + r * values.outerStride());
}

}  // namespace

void gelu(MatrixSpan values) {
  each_row(values, [&](float* row) { gelu_of(row, values.cols()); });
}

void hyperbolic_tangent(MatrixSpan values) {
  each_row(values, [&](float* row) { tanh_of(row, values.cols()); });
}

void rectify(MatrixSpan values) {
  each_row(values, [&](float* row) { drop_negatives(row, values.cols()); });
}

void leaky_rectify(MatrixSpan values) {
  constexpr float leak = 0.2F;
  each_row(values, [&](float* row) { scale_negatives(row, values.cols(), leak); });
}

void softmax_rows(MatrixSpan values) {
  const Eigen::Index count = values.cols();
  each_row(values, [&](float* row) {
    exponentials_of(row, count, largest_of(row, count));
    Eigen::Map<Eigen::RowVectorXf>(row, count) *= 1 / sum_of(row, count);
  });
}

void normalise_rows(MatrixSpan values, const Eigen::RowVectorXf& scale, const Eigen::RowVectorXf& shift) {
  constexpr float smallest_variance = 1e-5F;
  const Eigen::Index count = values.cols();
  const auto channels = static_cast<float>(count);
  each_row(values, [&](float* begin) {
    Eigen::Map<Eigen::RowVectorXf> row(begin, count);
    row.array() -= sum_of(begin, count) / channels;
    const float deviation = std::sqrt(squares_of(begin, count) / channels + smallest_variance);
    row.array() = row.array() * (1 / deviation) * scale.array() + shift.array();
  });
}

}  // namespace rhizodont::networks
