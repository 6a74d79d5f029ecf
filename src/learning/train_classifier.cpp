// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// Panoramas: B. Shi et al., "DeepPano", 2015. Batch normalisation: S. Ioffe, C. Szegedy, 2015. Missing places: Z. Zhong
// et al., "Random erasing data augmentation", 2017. Smoothed labels: C. Szegedy et al., 2016.
#include "learning/train_classifier.hpp"

#include <torch/torch.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/option_range.hpp"
#include "base/stopwatch.hpp"
#include "learning/threads.hpp"
#include "learning/weights.hpp"
#include "rhizodont/error.hpp"

namespace rhizodont {
namespace {

namespace nn = torch::nn;
using torch::indexing::Slice;

constexpr std::array<std::int64_t, 5> factors{1, 2, 2, 4, 4};  // channels of the maps, over the width
constexpr std::array<std::int64_t, 5> strides{1, 2, 1, 2, 1};
constexpr std::array<std::int64_t, 3> kernels{3, 5, 5};  // of the convolutions around the axis

/// Columns wrap around, beyond the rows there is nothing.
torch::Tensor padded(const torch::Tensor& x, std::int64_t columns, std::int64_t rows) {
  namespace F = nn::functional;
  const torch::Tensor wrapped =
      torch::cat({x.narrow(-1, x.size(-1) - columns, columns), x, x.narrow(-1, 0, columns)}, -1);
  return rows > 0 ? F::pad(wrapped, F::PadFuncOptions({0, 0, rows, rows})) : wrapped;
}

struct PanoramaNetImpl : nn::Module {
  PanoramaNetImpl(const LabelledPanoramas& of, const ClassifierTrainingOptions& o) {
    std::int64_t channels = static_cast<std::int64_t>(of.channels) + 1, rows = static_cast<std::int64_t>(of.rows);
    for (std::size_t i = 0; i < factors.size(); ++i) {
      maps->push_back(nn::Conv2d(nn::Conv2dOptions(channels, factors[i] * o.width, 3).stride(strides[i]).bias(false)));
      channels = factors[i] * o.width, rows /= strides[i];
      map_norms->push_back(nn::BatchNorm2d(channels));
    }
    channels *= rows;
    for (const std::int64_t kernel : kernels) {
      around->push_back(nn::Conv1d(nn::Conv1dOptions(channels, 6 * o.width, kernel).bias(false)));
      channels = 6 * o.width;
      around_norms->push_back(nn::BatchNorm1d(channels));
    }
    dense->push_back(nn::Linear(2 * channels, 96));
    dense->push_back(nn::Linear(96, o.classes));
    dropout = nn::Dropout(o.dropout);
    for (const auto& [name, list] :
         {std::pair("maps", maps), std::pair("map_norms", map_norms), std::pair("around", around),
          std::pair("around_norms", around_norms), std::pair("dense", dense)})
      register_module(name, list);
    register_module("dropout", dropout);
  }

  torch::Tensor forward(torch::Tensor x) {
    const torch::Tensor row = torch::linspace(-1, 1, x.size(2)).view({1, 1, -1, 1});
    x = torch::cat({x, row.expand({x.size(0), 1, x.size(2), x.size(3)})}, 1);
    for (std::size_t i = 0; i < maps->size(); ++i)
      x = torch::relu(
          map_norms[i]->as<nn::BatchNorm2d>()->forward(maps[i]->as<nn::Conv2d>()->forward(padded(x, 1, 1))));
    x = x.flatten(1, 2);
    const auto turned = [&](std::size_t i) {
      return torch::relu(around_norms[i]->as<nn::BatchNorm1d>()->forward(
          around[i]->as<nn::Conv1d>()->forward(padded(x, kernels[i] / 2, 0))));
    };
    x = turned(0);
    x = turned(1);
    x = x + turned(2);
    x = torch::cat({x.mean(2), x.amax(2)}, 1);
    x = dropout(torch::relu(dense[0]->as<nn::Linear>()->forward(dropout(x))));
    return dense[1]->as<nn::Linear>()->forward(x);
  }

  nn::ModuleList maps, map_norms, around, around_norms, dense;
  nn::Dropout dropout{nullptr};
};
TORCH_MODULE(PanoramaNet);

/// A convolution with the normalisation that follows it, as one.
void store_folded(const std::string& name, const torch::Tensor& weight, const nn::BatchNormOptions& options,
                  const torch::Tensor& scale, const torch::Tensor& shift, const torch::Tensor& mean,
                  const torch::Tensor& variance, TensorFile& file) {
  const torch::Tensor factor = scale / torch::sqrt(variance + options.eps());
  std::vector<std::int64_t> shape(static_cast<std::size_t>(weight.dim()), 1);
  shape[0] = -1;
  file.tensors[name + ".weight"] = store_tensor(weight * factor.view(shape), TensorType::float32);
  file.tensors[name + ".bias"] = store_tensor(shift - mean * factor, TensorType::float32);
}

TensorFile folded(PanoramaNet& net) {
  const torch::NoGradGuard no_gradient;
  TensorFile file;
  for (std::size_t i = 0; i < net->maps->size(); ++i) {
    const auto& norm = *net->map_norms[i]->as<nn::BatchNorm2d>();
    store_folded("maps." + std::to_string(i), net->maps[i]->as<nn::Conv2d>()->weight, norm.options, norm.weight,
                 norm.bias, norm.running_mean, norm.running_var, file);
  }
  for (std::size_t i = 0; i < net->around->size(); ++i) {
    const auto& norm = *net->around_norms[i]->as<nn::BatchNorm1d>();
    store_folded("around." + std::to_string(i), net->around[i]->as<nn::Conv1d>()->weight, norm.options, norm.weight,
                 norm.bias, norm.running_mean, norm.running_var, file);
  }
  for (std::size_t i = 0; i < net->dense->size(); ++i) {
    const auto* layer = net->dense[i]->as<nn::Linear>();
    file.tensors["dense." + std::to_string(i) + ".weight"] = store_tensor(layer->weight, TensorType::float32);
    file.tensors["dense." + std::to_string(i) + ".bias"] = store_tensor(layer->bias, TensorType::float32);
  }
  return file;
}

/// How a panorama is varied; all are lengths of a random tensor's axis or standard deviations in the panorama's units.
constexpr double scale_deviation = 0.05, wave_deviation = 0.008, distance_noise = 0.006, normal_noise = 0.06;
constexpr double missing_share = 0.5, smoothed_share = 0.4;

/// A few rectangles of nothing, as where neighbours hid the surface.
void take_places_out(torch::Tensor x) {
  const auto draw = [](std::int64_t low, std::int64_t high) {
    return torch::randint(low, high, {1}, torch::kLong).item<std::int64_t>();
  };
  const std::int64_t rows = x.size(1), columns = x.size(2);
  for (std::int64_t i = draw(1, 4); i > 0; --i) {
    const std::int64_t height = draw(2, 8), width = draw(2, 9);
    const std::int64_t row = draw(0, std::max<std::int64_t>(1, rows - 8));
    const std::int64_t column = draw(0, std::max<std::int64_t>(1, columns - width));
    x.index_put_({Slice(), Slice(row, row + height), Slice(column, column + width)}, 0);
  }
}

/// Scanners and reconstructions round grooves and edges off: the mean of what was hit around each place.
torch::Tensor smoothed(const torch::Tensor& x) {
  namespace F = nn::functional;
  const auto mean = [](const torch::Tensor& map) {
    return F::avg_pool2d(padded(map, 1, 1), F::AvgPool2dFuncOptions(3).stride(1));
  };
  const torch::Tensor hit = x.narrow(1, 1, 1);
  const torch::Tensor around = mean(x) / mean(hit).clamp_min(0.1);
  return torch::cat({around.narrow(1, 0, 1) * hit, hit, around.narrow(1, 2, x.size(1) - 2) * hit}, 1);
}

struct Batch {
  torch::Tensor panoramas, labels;
};

Batch varied(torch::Tensor x, torch::Tensor labels, int classes) {
  namespace F = nn::functional;
  const std::int64_t count = x.size(0), channels = x.size(1), rows = x.size(2), columns = x.size(3);
  const torch::Tensor mirror = torch::rand({count}) < 0.5;
  torch::Tensor reflected = torch::flip(x, {3});
  reflected.select(1, 3).mul_(-1);
  x = torch::where(mirror.view({-1, 1, 1, 1}), reflected, x);
  labels = torch::where(mirror & (labels < classes - 1), labels.bitwise_xor(1), labels);
  const torch::Tensor turn =
      (torch::arange(columns).unsqueeze(0) + torch::randint(0, columns, {count, 1}, torch::kLong)).remainder(columns);
  x = x.gather(3, turn.view({count, 1, 1, columns}).expand({count, channels, rows, columns}));
  x = torch::where((torch::rand({count}) < smoothed_share).view({-1, 1, 1, 1}), smoothed(x), x);
  x = torch::where((torch::rand({count}) < 0.5 * smoothed_share).view({-1, 1, 1, 1}), smoothed(x), x);
  const torch::Tensor hit = x.select(1, 1).clone();
  const torch::Tensor waves =
      F::interpolate(torch::randn({count, 1, 4, 8}), F::InterpolateFuncOptions()
                                                         .size(std::vector<std::int64_t>{rows, columns})
                                                         .mode(torch::kBicubic)
                                                         .align_corners(false))
          .squeeze(1);
  x.select(1, 0)
      .mul_(1 + scale_deviation * torch::randn({count, 1, 1}))
      .add_(hit * (wave_deviation * waves +
                   distance_noise * torch::randn({count, rows, columns}) * torch::rand({count, 1, 1})));
  x.narrow(1, 2, channels - 2)
      .add_(hit.unsqueeze(1) * normal_noise * torch::randn({count, channels - 2, rows, columns}) *
            torch::rand({count, 1, 1, 1}));
  const torch::Tensor missing = torch::rand({count}) < missing_share;
  for (std::int64_t i = 0; i < count; ++i)
    if (missing[i].item<bool>()) take_places_out(x[i]);
  return {x, labels};
}

void require_fitting(const LabelledPanoramas& samples, const ClassifierTrainingOptions& o) {
  const std::size_t each = samples.channels * samples.rows * samples.columns;
  const bool fits = samples.channels == 5 && samples.rows % 4 == 0 && samples.columns % 4 == 0 && each > 0 &&
                    samples.labels.size() >= 2 && samples.values.size() == samples.labels.size() * each &&
                    std::all_of(samples.labels.begin(), samples.labels.end(),
                                [&](std::int32_t label) { return label >= 0 && label < o.classes; });
  if (!fits) throw UsageError("Panoramas and their labels do not fit each other.");
}

/// One cycle: up to the largest rate in a cosine, then down.
double rate_at(int step, const ClassifierTrainingOptions& o) {
  constexpr double rise = 0.3, first = 1.0 / 25, last = 1.0 / 2.5e5;
  const double progress = static_cast<double>(step) / o.steps;
  const auto cosine = [](double from, double to, double t) {
    return to + (from - to) * 0.5 * (1 + std::cos(std::numbers::pi * t));
  };
  return o.learning_rate *
         (progress < rise ? cosine(first, 1, progress / rise) : cosine(1, last, (progress - rise) / (1 - rise)));
}

}  // namespace

void require_in_range(const ClassifierTrainingOptions& o) {
  require_ranges("training", {{"steps", o.steps, OptionRange::at_least(10)},
                              {"batch", o.batch, OptionRange::at_least(2)},
                              {"learning_rate", o.learning_rate, OptionRange::above(0)},
                              {"weight_decay", o.weight_decay, OptionRange::at_least(0)},
                              {"label_smoothing", o.label_smoothing, OptionRange::at_least(0).below(1)},
                              {"dropout", o.dropout, OptionRange::at_least(0).below(1)},
                              {"width", o.width, OptionRange::at_least(1).at_most(256)},
                              {"classes", o.classes, OptionRange::at_least(3)},
                              {"threads", o.threads, OptionRange::at_least(1)},
                              {"report_steps", o.report_steps, OptionRange::at_least(1)}});
  if (o.classes % 2 == 0) throw UsageError("The option classes of training must be odd.");
}

TensorFile train_classifier(const LabelledPanoramas& samples, const ClassifierTrainingOptions& options) {
  require_in_range(options);
  require_fitting(samples, options);
  const TensorThreads threads(options.threads);
  torch::manual_seed(options.seed);
  PanoramaNet net(samples, options);
  torch::optim::AdamW optimiser(net->parameters(),
                                torch::optim::AdamWOptions(options.learning_rate).weight_decay(options.weight_decay));
  const auto count = static_cast<std::int64_t>(samples.labels.size());
  const torch::Tensor panoramas =
      torch::from_blob(const_cast<float*>(samples.values.data()),  // torch knows no pointer to const; nothing writes
                       {count, static_cast<std::int64_t>(samples.channels), static_cast<std::int64_t>(samples.rows),
                        static_cast<std::int64_t>(samples.columns)});
  const torch::Tensor labels = torch::tensor(samples.labels).to(torch::kLong);
  nn::CrossEntropyLoss criterion(nn::CrossEntropyLossOptions().label_smoothing(options.label_smoothing));
  const Stopwatch watch;
  double running = 0;
  for (int step = 0; step < options.steps; ++step) {
    for (auto& group : optimiser.param_groups())
      static_cast<torch::optim::AdamWOptions&>(group.options()).lr(rate_at(step, options));
    const torch::Tensor chosen = torch::randint(0, count, {options.batch}, torch::kLong);
    const Batch batch = varied(panoramas.index_select(0, chosen), labels.index_select(0, chosen), options.classes);
    const torch::Tensor loss = criterion->forward(net->forward(batch.panoramas), batch.labels);
    optimiser.zero_grad();
    loss.backward();
    optimiser.step();
    const double now = loss.item<double>();
    if (!std::isfinite(now)) throw NoResultError("Training came to a loss that is no number.");
    running = step == 0 ? now : 0.98 * running + 0.02 * now;
    if (options.progress && ((step + 1) % options.report_steps == 0 || step + 1 == options.steps)) {
      TrainingProgress progress;
      progress.steps = static_cast<std::uint64_t>(step) + 1;
      progress.samples = progress.steps * static_cast<std::uint64_t>(options.batch);
      progress.loss = running;
      progress.learning_rate = rate_at(step, options);
      progress.samples_per_second = static_cast<double>(progress.samples) / std::max(watch.seconds(), 1e-9);
      options.progress(progress);
    }
  }
  return folded(net);
}

}  // namespace rhizodont
