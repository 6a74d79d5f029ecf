// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// Loshchilov I., Hutter F.: Decoupled Weight Decay Regularization, ICLR 2019. Pascanu R., Mikolov T., Bengio Y.: On the
// Difficulty of Training Recurrent Neural Networks, 2013 (clipping). Polyak B., Juditsky A.: Acceleration of Stochastic
// Approximation by Averaging, 1992.
#include "learning/optimiser.hpp"

#include <ATen/Parallel.h>

#include <cmath>

#include "rhizodont/error.hpp"

namespace rhizodont {
namespace {

constexpr float beta_1 = 0.9F;
constexpr float beta_2 = 0.99F;  // a shorter memory than the usual 0.999 suits short trainings

struct Factors {
  float gradient;      // clipping
  float rate;          // learning rate over the first moment's bias correction
  float square_scale;  // one over the second moment's bias correction
  float decay;         // what weight decay leaves of a value
  float average;       // share of the old running mean
};

[[gnu::target_clones("avx512f", "avx2", "default")]] void update(float* value, float* mean, float* square,
                                                                 float* average, const float* gradient,
                                                                 std::int64_t count, const Factors& f) {
  for (std::int64_t i = 0; i < count; ++i) {
    const float g = gradient[i] * f.gradient;
    const float m = beta_1 * mean[i] + (1 - beta_1) * g;
    const float s = beta_2 * square[i] + (1 - beta_2) * g * g;
    const float v = value[i] * f.decay - f.rate * m / (std::sqrt(s * f.square_scale) + 1e-8F);
    mean[i] = m;
    square[i] = s;
    value[i] = v;
    average[i] += (1 - f.average) * (v - average[i]);
  }
}

double gradient_norm(const std::vector<torch::Tensor>& gradients) {
  double sum = 0;
  for (const torch::Tensor& gradient : gradients) {
    if (!gradient.defined()) continue;
    const double norm = gradient.norm().item<double>();
    sum += norm * norm;
  }
  return std::sqrt(sum);
}

}  // namespace

std::vector<TrainedTensor> trained_tensors(const torch::nn::Module& module) {
  std::vector<TrainedTensor> tensors;
  for (const auto& item : module.named_parameters()) {
    const torch::Tensor value = item.value().detach();  // shares memory with the parameter
    const bool matrix = item.key().ends_with("weight") && value.dim() >= 2;
    tensors.push_back({item.key(), value, torch::zeros_like(value), torch::zeros_like(value), value.clone(), matrix});
  }
  return tensors;
}

double adamw_step(std::vector<TrainedTensor>& tensors, const std::vector<torch::Tensor>& gradients,
                  const StepOptions& options) {
  const double norm = gradient_norm(gradients);
  if (!std::isfinite(norm)) throw NoResultError("Training came to a gradient that is not a number.");
  const auto step = static_cast<double>(options.step);
  const double correction_1 = 1 - std::pow(static_cast<double>(beta_1), step);
  const double correction_2 = 1 - std::pow(static_cast<double>(beta_2), step);
  Factors factors{};
  factors.gradient = static_cast<float>(norm > options.clip ? options.clip / norm : 1);
  factors.rate = static_cast<float>(options.learning_rate / correction_1);
  factors.square_scale = static_cast<float>(1 / correction_2);
  factors.average = static_cast<float>(options.average_decay);
  at::parallel_for(0, static_cast<std::int64_t>(tensors.size()), 1, [&](std::int64_t begin, std::int64_t end) {
    for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
      TrainedTensor& tensor = tensors[i];
      Factors own = factors;
      own.decay = static_cast<float>(tensor.decays ? 1 - options.learning_rate * options.weight_decay : 1);
      const torch::Tensor gradient =
          gradients[i].defined() ? gradients[i].to(torch::kFloat).contiguous() : torch::zeros_like(tensor.value);
      update(tensor.value.data_ptr<float>(), tensor.mean.data_ptr<float>(), tensor.square.data_ptr<float>(),
             tensor.average.data_ptr<float>(), gradient.data_ptr<float>(), gradient.numel(), own);
    }
  });
  return norm;
}

}  // namespace rhizodont
