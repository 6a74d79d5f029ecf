// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// P. J. Huber, "Robust estimation of a location parameter", 1964.
#include "learning/train_pose.hpp"

#include <torch/torch.h>

#include <algorithm>
#include <numbers>

#include "base/option_range.hpp"
#include "learning/panorama_net.hpp"
#include "learning/threads.hpp"
#include "learning/weights.hpp"
#include "rhizodont/error.hpp"

namespace rhizodont {
namespace {

namespace nn = torch::nn;

constexpr std::int64_t types = 16, said_of_type = 3, columns_per_place = 4;

/// What is said of each place around the axis: [n, types, 3, places].
struct PoseNetImpl : nn::Module {
  PoseNetImpl(const LabelledPanoramas& of, int width)
      : trunk(static_cast<std::int64_t>(of.channels), static_cast<std::int64_t>(of.rows), width),
        around(nn::Conv1dOptions(std::int64_t{6} * width, std::int64_t{6} * width, 5).bias(false)),
        around_norm(std::int64_t{6} * width),
        said(nn::Conv1dOptions(std::int64_t{6} * width, types * said_of_type, 1)) {
    register_module("trunk", trunk);
    register_module("around", around);
    register_module("around_norm", around_norm);
    register_module("said", said);
  }

  torch::Tensor forward(const torch::Tensor& x) {
    const torch::Tensor places = said(convolved_around(trunk(x), around, around_norm));
    return places.view({x.size(0), types, said_of_type, places.size(2)});
  }

  PanoramaTrunk trunk;
  nn::Conv1d around;
  nn::BatchNorm1d around_norm;
  nn::Conv1d said;
};
TORCH_MODULE(PoseNet);

TensorFile folded(PoseNet& net) {
  const torch::NoGradGuard no_gradient;
  TensorFile file;
  net->trunk->store(file);
  store_folded("pose.0", *net->around, *net->around_norm, file);
  file.tensors["pose.1.weight"] = store_tensor(net->said->weight.squeeze(2), TensorType::float32);
  file.tensors["pose.1.bias"] = store_tensor(net->said->bias, TensorType::float32);
  return file;
}

/// Places' azimuths, in the unit of one place's width: place p is where column 4 p is, whose middle is half a column
/// on.
torch::Tensor place_numbers(std::int64_t places) { return torch::arange(places) + 0.5 / columns_per_place; }

/// Cross entropy with the azimuth shared out between the two nearest places.
torch::Tensor turn_loss(const torch::Tensor& scores, const torch::Tensor& azimuths) {
  const std::int64_t places = scores.size(1);
  const torch::Tensor number = azimuths.unsqueeze(1) * (static_cast<double>(places) / (2 * std::numbers::pi)) -
                               place_numbers(places).unsqueeze(0);
  const torch::Tensor apart = (number - places * torch::round(number / places)).abs();
  return -((1 - apart).clamp_min(0) * torch::log_softmax(scores, 1)).sum(1).mean();
}

/// Sum over the places of the lean towards each and along the columns there: [n, 2].
torch::Tensor lean_of(const torch::Tensor& towards, const torch::Tensor& along) {
  const torch::Tensor azimuth =
      place_numbers(towards.size(1)) * (2 * std::numbers::pi / static_cast<double>(towards.size(1)));
  const torch::Tensor cosine = torch::cos(azimuth), sine = torch::sin(azimuth);
  return torch::stack({(cosine * towards - sine * along).sum(1), (sine * towards + cosine * along).sum(1)}, 1);
}

void require_fitting(const PosedPanoramas& samples) {
  const LabelledPanoramas& of = samples.panoramas;
  const std::size_t each = of.channels * of.rows * of.columns, count = of.labels.size();
  const bool fits = of.channels == 5 && of.rows % 4 == 0 && of.columns % 4 == 0 && each > 0 && count >= 2 &&
                    of.values.size() == count * each && samples.azimuths.size() == count &&
                    samples.leans.size() == 2 * count &&
                    std::all_of(of.labels.begin(), of.labels.end(), [](int type) { return type >= 0 && type < types; });
  if (!fits) throw UsageError("Panoramas and their poses do not fit each other.");
}

}  // namespace

void require_in_range(const PoseTrainingOptions& o) {
  require_ranges("training", {{"steps", o.steps, OptionRange::at_least(10)},
                              {"batch", o.batch, OptionRange::at_least(2)},
                              {"learning_rate", o.learning_rate, OptionRange::above(0)},
                              {"weight_decay", o.weight_decay, OptionRange::at_least(0)},
                              {"lean_weight", o.lean_weight, OptionRange::above(0)},
                              {"width", o.width, OptionRange::at_least(1).at_most(256)},
                              {"threads", o.threads, OptionRange::at_least(1)},
                              {"report_steps", o.report_steps, OptionRange::at_least(1)}});
}

TensorFile train_pose(const PosedPanoramas& samples, const PoseTrainingOptions& options) {
  require_in_range(options);
  require_fitting(samples);
  const TensorThreads threads(options.threads);
  torch::manual_seed(options.seed);
  PoseNet net(samples.panoramas, options.width);
  const torch::Tensor panoramas = panoramas_of(samples.panoramas);
  const torch::Tensor labels = torch::tensor(samples.panoramas.labels).to(torch::kLong);
  const torch::Tensor azimuths = torch::tensor(samples.azimuths), leans = torch::tensor(samples.leans).view({-1, 2});
  nn::SmoothL1Loss huber(nn::SmoothL1LossOptions().beta(0.05));
  const PanoramaSteps how{options.steps,         options.batch,        options.report_steps,
                          options.learning_rate, options.weight_decay, options.progress};
  train_on_panoramas(*net, how, [&] {
    const torch::Tensor chosen = torch::randint(0, panoramas.size(0), {options.batch}, torch::kLong);
    torch::Tensor x = panoramas.index_select(0, chosen);
    const torch::Tensor by = torch::randint(0, x.size(3), {options.batch, 1}, torch::kLong);
    const torch::Tensor turn = by.squeeze(1) * (2 * std::numbers::pi / static_cast<double>(x.size(3)));
    x = scanned_anew(turned_by(by, x));
    const torch::Tensor all = net(x);
    const torch::Tensor said = all.index({torch::arange(options.batch), labels.index_select(0, chosen)});
    const torch::Tensor before = leans.index_select(0, chosen), cosine = torch::cos(turn), sine = torch::sin(turn);
    const torch::Tensor lean = torch::stack({cosine * before.select(1, 0) + sine * before.select(1, 1),
                                             cosine * before.select(1, 1) - sine * before.select(1, 0)},
                                            1);
    return turn_loss(said.select(1, 0), azimuths.index_select(0, chosen) - turn) +
           options.lean_weight * huber(lean_of(said.select(1, 1), said.select(1, 2)), lean);
  });
  return folded(net);
}

}  // namespace rhizodont
