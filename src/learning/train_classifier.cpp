// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// Smoothed labels: C. Szegedy et al., 2016.
#include "learning/train_classifier.hpp"

#include <torch/torch.h>

#include <algorithm>

#include "base/option_range.hpp"
#include "learning/panorama_net.hpp"
#include "learning/threads.hpp"
#include "learning/weights.hpp"
#include "rhizodont/error.hpp"

namespace rhizodont {
namespace {

namespace nn = torch::nn;

struct ClassifierNetImpl : nn::Module {
  ClassifierNetImpl(const LabelledPanoramas& of, const ClassifierTrainingOptions& o)
      : trunk(static_cast<std::int64_t>(of.channels), static_cast<std::int64_t>(of.rows), o.width) {
    dense->push_back(nn::Linear(std::int64_t{12} * o.width, 96));
    dense->push_back(nn::Linear(96, o.classes));
    dropout = nn::Dropout(o.dropout);
    register_module("trunk", trunk);
    register_module("dense", dense);
    register_module("dropout", dropout);
  }

  torch::Tensor forward(torch::Tensor x) {
    x = trunk->forward(x);
    x = torch::cat({x.mean(2), x.amax(2)}, 1);
    x = dropout(torch::relu(dense[0]->as<nn::Linear>()->forward(dropout(x))));
    return dense[1]->as<nn::Linear>()->forward(x);
  }

  PanoramaTrunk trunk;
  nn::ModuleList dense;
  nn::Dropout dropout{nullptr};
};
TORCH_MODULE(ClassifierNet);

TensorFile folded(ClassifierNet& net) {
  const torch::NoGradGuard no_gradient;
  TensorFile file;
  net->trunk->store(file);
  for (std::size_t i = 0; i < net->dense->size(); ++i) {
    const auto* layer = net->dense[i]->as<nn::Linear>();
    file.tensors["dense." + std::to_string(i) + ".weight"] = store_tensor(layer->weight, TensorType::float32);
    file.tensors["dense." + std::to_string(i) + ".bias"] = store_tensor(layer->bias, TensorType::float32);
  }
  return file;
}

struct Batch {
  torch::Tensor panoramas, labels;
};

Batch varied(torch::Tensor x, torch::Tensor labels, int classes) {
  const std::int64_t count = x.size(0);
  const torch::Tensor mirror = torch::rand({count}) < 0.5;
  x = mirrored_where(mirror, x);
  labels = torch::where(mirror & (labels < classes - 1), labels.bitwise_xor(1), labels);
  x = turned_by(torch::randint(0, x.size(3), {count, 1}, torch::kLong), x);
  return {scanned_anew(x), labels};
}

void require_fitting(const LabelledPanoramas& samples, const ClassifierTrainingOptions& o) {
  const std::size_t each = samples.channels * samples.rows * samples.columns;
  const bool fits = samples.channels == 5 && samples.rows % 4 == 0 && samples.columns % 4 == 0 && each > 0 &&
                    samples.labels.size() >= 2 && samples.values.size() == samples.labels.size() * each &&
                    std::all_of(samples.labels.begin(), samples.labels.end(),
                                [&](std::int32_t label) { return label >= 0 && label < o.classes; });
  if (!fits) throw UsageError("Panoramas and their labels do not fit each other.");
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
  ClassifierNet net(samples, options);
  const torch::Tensor panoramas = panoramas_of(samples);
  const torch::Tensor labels = torch::tensor(samples.labels).to(torch::kLong);
  nn::CrossEntropyLoss criterion(nn::CrossEntropyLossOptions().label_smoothing(options.label_smoothing));
  const PanoramaSteps how{options.steps,         options.batch,        options.report_steps,
                          options.learning_rate, options.weight_decay, options.progress};
  train_on_panoramas(*net, how, [&] {
    const torch::Tensor chosen = torch::randint(0, panoramas.size(0), {options.batch}, torch::kLong);
    const Batch batch = varied(panoramas.index_select(0, chosen), labels.index_select(0, chosen), options.classes);
    return criterion->forward(net->forward(batch.panoramas), batch.labels);
  });
  return folded(net);
}

}  // namespace rhizodont
