// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "completion/tooth_classifier.hpp"

#include "rhizodont/error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace rhizodont {
namespace {

using Shape = std::vector<std::int64_t>;

/// Layers and their shapes for a network of width 2.
const std::vector<std::pair<std::string, Shape>>& layers() {
  static const std::vector<std::pair<std::string, Shape>> all{
      {"maps.0", {2, 6, 3, 3}}, {"maps.1", {4, 2, 3, 3}},  {"maps.2", {4, 4, 3, 3}},  {"maps.3", {8, 4, 3, 3}},
      {"maps.4", {8, 8, 3, 3}}, {"around.0", {12, 48, 3}}, {"around.1", {12, 12, 5}}, {"around.2", {12, 12, 5}},
      {"dense.0", {10, 24}},    {"dense.1", {33, 10}}};
  return all;
}

TensorFile drawn_weights() {
  std::mt19937 random(5);
  std::normal_distribution<float> normal;
  TensorFile file;
  for (const auto& [name, shape] : layers()) {
    std::int64_t count = 1;
    for (const std::int64_t n : shape) count *= n;
    std::vector<float> values(static_cast<std::size_t>(count)), bias(static_cast<std::size_t>(shape[0]));
    const float scale = std::sqrt(2.0F * static_cast<float>(shape[0]) / static_cast<float>(count));
    for (float& v : values) v = scale * normal(random);
    for (float& v : bias) v = 0.1F * normal(random);
    file.tensors[name + ".weight"] = store_floats(values, shape);
    file.tensors[name + ".bias"] = store_floats(bias, {shape[0]});
  }
  return file;
}

CrownPanorama drawn_panorama() {
  std::mt19937 random(9);
  std::uniform_real_distribution<float> uniform(-1, 1);
  CrownPanorama panorama;
  panorama.values.resize(CrownPanorama::channels * CrownPanorama::rows * CrownPanorama::columns);
  for (float& v : panorama.values) v = uniform(random);
  return panorama;
}

/// The definition, place by place: channel, row, column.
struct Plain {
  std::size_t channels, rows, columns;
  std::vector<double> values;
  double& at(std::size_t k, std::size_t r, std::size_t c) { return values[(k * rows + r) * columns + c]; }
};

Plain convolved(Plain x, const TensorFile& file, const std::string& name, std::size_t stride) {
  const StoredTensor& stored = file.tensors.at(name + ".weight");
  const std::vector<float> weight = load_floats(stored), bias = load_floats(file.tensors.at(name + ".bias"));
  const bool flat = stored.shape.size() == 3;
  const std::size_t height = flat ? 1 : 3, width = static_cast<std::size_t>(stored.shape.back());
  const auto outputs = static_cast<std::size_t>(stored.shape[0]);
  Plain y{outputs, x.rows / stride, x.columns / stride, {}};
  y.values.resize(y.channels * y.rows * y.columns);
  for (std::size_t o = 0; o < outputs; ++o)
    for (std::size_t r = 0; r < y.rows; ++r)
      for (std::size_t c = 0; c < y.columns; ++c) {
        double sum = double{bias[o]};
        for (std::size_t k = 0; k < x.channels; ++k)
          for (std::size_t i = 0; i < height; ++i)
            for (std::size_t j = 0; j < width; ++j) {
              const std::size_t row = r * stride + i + 1 - (height > 1 ? 2 : 1);  // wraps to a huge number below 0
              if (row >= x.rows) continue;
              const std::size_t column = (c * stride + j + x.columns - width / 2) % x.columns;
              sum += double{weight[((o * x.channels + k) * height + i) * width + j]} * x.at(k, row, column);
            }
        y.at(o, r, c) = std::max(sum, 0.0);
      }
  return y;
}

std::vector<double> dense(const std::vector<double>& x, const TensorFile& file, const std::string& name, bool last) {
  const std::vector<float> weight = load_floats(file.tensors.at(name + ".weight"));
  std::vector<double> y;
  for (const float b : load_floats(file.tensors.at(name + ".bias"))) {
    double sum = double{b};
    for (std::size_t i = 0; i < x.size(); ++i) sum += double{weight[y.size() * x.size() + i]} * x[i];
    y.push_back(last ? sum : std::max(sum, 0.0));
  }
  return y;
}

std::vector<double> log_probabilities(const CrownPanorama& panorama, const TensorFile& file) {
  Plain x{CrownPanorama::channels + 1,
          CrownPanorama::rows,
          CrownPanorama::columns,
          {panorama.values.begin(), panorama.values.end()}};
  for (std::size_t r = 0; r < x.rows; ++r)
    x.values.insert(x.values.end(), x.columns, 2.0 * static_cast<double>(r) / static_cast<double>(x.rows - 1) - 1);
  const std::vector<std::size_t> strides{1, 2, 1, 2, 1};
  for (std::size_t i = 0; i < strides.size(); ++i) x = convolved(x, file, "maps." + std::to_string(i), strides[i]);
  x.channels *= x.rows, x.rows = 1;
  x = convolved(convolved(x, file, "around.0", 1), file, "around.1", 1);
  const Plain more = convolved(x, file, "around.2", 1);
  std::vector<double> mean(x.channels, 0), most(x.channels, -1e9);
  for (std::size_t k = 0; k < x.channels; ++k)
    for (std::size_t c = 0; c < x.columns; ++c) {
      const double v = x.values[k * x.columns + c] + more.values[k * x.columns + c];
      mean[k] += v / static_cast<double>(x.columns);
      most[k] = std::max(most[k], v);
    }
  mean.insert(mean.end(), most.begin(), most.end());
  std::vector<double> scores = dense(dense(mean, file, "dense.0", false), file, "dense.1", true);
  double sum = 0;
  for (const double s : scores) sum += std::exp(s);
  for (double& s : scores) s -= std::log(sum);
  return scores;
}

CrownPanorama reflected(const CrownPanorama& panorama) {
  CrownPanorama result = panorama;
  for (std::size_t k = 0; k < CrownPanorama::channels; ++k)
    for (std::size_t r = 0; r < CrownPanorama::rows; ++r)
      for (std::size_t c = 0; c < CrownPanorama::columns; ++c) {
        const std::size_t line = (k * CrownPanorama::rows + r) * CrownPanorama::columns;
        result.values[line + c] = (k == 3 ? -1.0F : 1.0F) * panorama.values[line + CrownPanorama::columns - 1 - c];
      }
  return result;
}

TEST(ToothClassifier, DoesWhatItsDefinitionSays) {
  const TensorFile file = drawn_weights();
  const CrownPanorama panorama = drawn_panorama();
  const ToothProbabilities said = ToothClassifier(file)(panorama);
  const auto straight = log_probabilities(panorama, file), mirrored = log_probabilities(reflected(panorama), file);
  double sum = 0;
  std::vector<double> mean;
  for (std::size_t i = 0; i <= tooth_count; ++i) {
    mean.push_back(0.5 * (straight[i] + mirrored[i < tooth_count ? i ^ 1U : i]));
    sum += std::exp(mean.back());
  }
  for (std::size_t i = 0; i < tooth_count; ++i) EXPECT_NEAR(said.log_tooth[i], mean[i] - std::log(sum), 2e-4);
  EXPECT_NEAR(said.log_unlike, mean[tooth_count] - std::log(sum), 2e-4);
}

TEST(ToothClassifier, MirroringSwapsTheSides) {
  const ToothClassifier classifier(drawn_weights());
  const ToothProbabilities one = classifier(drawn_panorama()), other = classifier(reflected(drawn_panorama()));
  double total = std::exp(one.log_unlike);
  for (std::size_t i = 0; i < tooth_count; ++i) {
    EXPECT_NEAR(one.log_tooth[i], other.log_tooth[i ^ 1U], 1e-9);
    total += std::exp(one.log_tooth[i]);
  }
  EXPECT_NEAR(total, 1, 1e-9);
}

TEST(ToothClassifier, DamagedWeightsAreRefused) {
  for (const auto& [name, shape] : layers()) {
    TensorFile without = drawn_weights(), other = drawn_weights(), infinite = drawn_weights();
    without.tensors.erase(name + ".bias");
    EXPECT_THROW(ToothClassifier{without}, InputError) << name;
    Shape grown = shape;
    grown[0] += 1;
    std::int64_t count = 1;
    for (const std::int64_t n : grown) count *= n;
    other.tensors[name + ".weight"] = store_floats(std::vector<float>(static_cast<std::size_t>(count)), grown);
    EXPECT_THROW(ToothClassifier{other}, InputError) << name;
    std::vector<float> bias(static_cast<std::size_t>(shape[0]), std::numeric_limits<float>::infinity());
    infinite.tensors[name + ".bias"] = store_floats(bias, {shape[0]});
    EXPECT_THROW(ToothClassifier{infinite}, InputError) << name;
  }
  EXPECT_THROW(ToothClassifier{TensorFile{}}, InputError);
}

}  // namespace
}  // namespace rhizodont
