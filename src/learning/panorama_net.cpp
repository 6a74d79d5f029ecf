// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// Panoramas: B. Shi et al., "DeepPano", 2015. Batch normalisation: S. Ioffe, C. Szegedy, 2015. Missing places: Z. Zhong
// et al., "Random erasing data augmentation", 2017.
#include "learning/panorama_net.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/stopwatch.hpp"
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

}  // namespace

PanoramaTrunkImpl::PanoramaTrunkImpl(std::int64_t channels, std::int64_t rows, int width) {
  ++channels;  // which row it is
  for (std::size_t i = 0; i < factors.size(); ++i) {
    maps->push_back(nn::Conv2d(nn::Conv2dOptions(channels, factors[i] * width, 3).stride(strides[i]).bias(false)));
    channels = factors[i] * width, rows /= strides[i];
    map_norms->push_back(nn::BatchNorm2d(channels));
  }
  channels *= rows;
  for (const std::int64_t kernel : kernels) {
    around->push_back(nn::Conv1d(nn::Conv1dOptions(channels, std::int64_t{6} * width, kernel).bias(false)));
    channels = std::int64_t{6} * width;
    around_norms->push_back(nn::BatchNorm1d(channels));
  }
  register_module("maps", maps);
  register_module("map_norms", map_norms);
  register_module("around", around);
  register_module("around_norms", around_norms);
}

torch::Tensor PanoramaTrunkImpl::forward(torch::Tensor x) {
  const torch::Tensor row = torch::linspace(-1, 1, x.size(2)).view({1, 1, -1, 1});
  x = torch::cat({x, row.expand({x.size(0), 1, x.size(2), x.size(3)})}, 1);
  for (std::size_t i = 0; i < maps->size(); ++i)
    x = torch::relu(map_norms[i]->as<nn::BatchNorm2d>()->forward(maps[i]->as<nn::Conv2d>()->forward(padded(x, 1, 1))));
  x = x.flatten(1, 2);
  const auto turned = [&](std::size_t i) {
    return convolved_around(x, nn::Conv1d(std::dynamic_pointer_cast<nn::Conv1dImpl>(around->ptr(i))),
                            nn::BatchNorm1d(std::dynamic_pointer_cast<nn::BatchNorm1dImpl>(around_norms->ptr(i))));
  };
  x = turned(0);
  x = turned(1);
  return x + turned(2);
}

void PanoramaTrunkImpl::store(TensorFile& file) {
  for (std::size_t i = 0; i < maps->size(); ++i)
    store_folded("maps." + std::to_string(i), *maps[i]->as<nn::Conv2d>(), *map_norms[i]->as<nn::BatchNorm2d>(), file);
  for (std::size_t i = 0; i < around->size(); ++i)
    store_folded("around." + std::to_string(i), *around[i]->as<nn::Conv1d>(), *around_norms[i]->as<nn::BatchNorm1d>(),
                 file);
}

torch::Tensor convolved_around(const torch::Tensor& x, nn::Conv1d convolution, nn::BatchNorm1d norm) {
  return torch::relu(norm(convolution(padded(x, convolution->options.kernel_size()->at(0) / 2, 0))));
}

template <class Convolution, class Norm>
void store_folded(const std::string& name, const Convolution& convolution, const Norm& norm, TensorFile& file) {
  const torch::Tensor factor = norm.weight / torch::sqrt(norm.running_var + norm.options.eps());
  std::vector<std::int64_t> shape(static_cast<std::size_t>(convolution.weight.dim()), 1);
  shape[0] = -1;
  file.tensors[name + ".weight"] = store_tensor(convolution.weight * factor.view(shape), TensorType::float32);
  file.tensors[name + ".bias"] = store_tensor(norm.bias - norm.running_mean * factor, TensorType::float32);
}
template void store_folded(const std::string&, const nn::Conv1dImpl&, const nn::BatchNorm1dImpl&, TensorFile&);
template void store_folded(const std::string&, const nn::Conv2dImpl&, const nn::BatchNorm2dImpl&, TensorFile&);

torch::Tensor panoramas_of(const LabelledPanoramas& samples) {
  return torch::from_blob(
      const_cast<float*>(samples.values.data()),  // torch knows no pointer to const; nothing writes
      {static_cast<std::int64_t>(samples.labels.size()), static_cast<std::int64_t>(samples.channels),
       static_cast<std::int64_t>(samples.rows), static_cast<std::int64_t>(samples.columns)});
}

torch::Tensor mirrored_where(const torch::Tensor& which, const torch::Tensor& panoramas) {
  torch::Tensor reflected = torch::flip(panoramas, {3});
  reflected.select(1, 3).mul_(-1);
  return torch::where(which.view({-1, 1, 1, 1}), reflected, panoramas);
}

torch::Tensor turned_by(const torch::Tensor& columns, const torch::Tensor& panoramas) {
  const std::int64_t count = panoramas.size(0), width = panoramas.size(3);
  const torch::Tensor from = (torch::arange(width).unsqueeze(0) + columns).remainder(width);
  return panoramas.gather(3,
                          from.view({count, 1, 1, width}).expand({count, panoramas.size(1), panoramas.size(2), width}));
}

torch::Tensor scanned_anew(torch::Tensor x) {
  namespace F = nn::functional;
  const std::int64_t count = x.size(0), channels = x.size(1), rows = x.size(2), columns = x.size(3);
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
  return x;
}

double one_cycle_rate(int step, int steps, double largest) {
  constexpr double rise = 0.3, first = 1.0 / 25, last = 1.0 / 2.5e5;
  const double progress = static_cast<double>(step) / steps;
  const auto cosine = [](double from, double to, double t) {
    return to + (from - to) * 0.5 * (1 + std::cos(std::numbers::pi * t));
  };
  return largest *
         (progress < rise ? cosine(first, 1, progress / rise) : cosine(1, last, (progress - rise) / (1 - rise)));
}

void train_on_panoramas(nn::Module& net, const PanoramaSteps& how,
                        const std::function<torch::Tensor()>& loss_of_batch) {
  torch::optim::AdamW optimiser(net.parameters(),
                                torch::optim::AdamWOptions(how.learning_rate).weight_decay(how.weight_decay));
  const Stopwatch watch;
  double running = 0;
  for (int step = 0; step < how.steps; ++step) {
    const double rate = one_cycle_rate(step, how.steps, how.learning_rate);
    for (auto& group : optimiser.param_groups()) static_cast<torch::optim::AdamWOptions&>(group.options()).lr(rate);
    const torch::Tensor loss = loss_of_batch();
    optimiser.zero_grad();
    loss.backward();
    optimiser.step();
    const double now = loss.item<double>();
    if (!std::isfinite(now)) throw NoResultError("Training came to a loss that is no number.");
    running = step == 0 ? now : 0.98 * running + 0.02 * now;
    if (how.progress && ((step + 1) % how.report_steps == 0 || step + 1 == how.steps)) {
      TrainingProgress progress;
      progress.steps = static_cast<std::uint64_t>(step) + 1;
      progress.samples = progress.steps * static_cast<std::uint64_t>(how.batch);
      progress.loss = running;
      progress.learning_rate = rate;
      progress.samples_per_second = static_cast<double>(progress.samples) / std::max(watch.seconds(), 1e-9);
      how.progress(progress);
    }
  }
}

}  // namespace rhizodont
