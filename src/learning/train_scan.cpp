// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "learning/train_scan.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "base/option_range.hpp"
#include "learning/checkpoint.hpp"
#include "learning/scan_net.hpp"
#include "learning/threads.hpp"
#include "learning/training_loop.hpp"
#include "learning/vary_cloud.hpp"
#include "rhizodont/error.hpp"

namespace rhizodont {
namespace {

void require_in_range(const ScanTrainingOptions& options) {
  check_scan_shape(options.shape);
  require_in_range(options.loop);
  const ScanVariation& v = options.variation;
  require_ranges("training", {{"pool", options.pool, OptionRange::at_least(1).below(first_validation_sample)},
                              {"any_turn_share", v.any_turn_share, share_range},
                              {"turn", v.turn, OptionRange::at_least(0)},
                              {"tilt", v.tilt, OptionRange::at_least(0)},
                              {"strong_tilt_share", v.strong_tilt_share, share_range},
                              {"size", v.size, OptionRange::at_least(0)},
                              {"bend", v.bend, OptionRange::at_least(0)},
                              {"crop_share", v.crop_share, share_range},
                              {"trim_share", v.trim_share, share_range},
                              {"noise_mm", v.noise_mm, OptionRange::at_least(0)}});
}

/// What held-out scans are shown with.
ScanVariation little_variation() {
  return {.any_turn_share = 0,
          .turn = 0.05,
          .tilt = 0.05,
          .strong_tilt_share = 0,
          .size = 0,
          .bend = 0,
          .crop_share = 0,
          .trim_share = 0,
          .noise_mm = 0};
}

/// A shown scan as tensors.
struct ScanExample {
  ScanTensors scan;
  torch::Tensor kinds;       // int64, n
  torch::Tensor middles;     // float, n x 3
  torch::Tensor borders;     // float, n
  torch::Tensor upper;       // float, 1
  torch::Tensor directions;  // float, 6
};

ScanExample to_example(const ShownScan& shown, const ScanShape& shape) {
  ScanExample example;
  example.scan = to_tensors(shown.pyramid, shape);
  example.kinds = torch::tensor(shown.kinds, torch::kLong);
  example.middles = torch::tensor(shown.middles).view({-1, 3});
  example.borders = torch::tensor(shown.borders);
  example.upper = torch::tensor({shown.upper ? 1.0F : 0.0F});
  std::vector<float> directions(shown.front.begin(), shown.front.end());
  directions.insert(directions.end(), shown.occlusal.begin(), shown.occlusal.end());
  example.directions = torch::tensor(directions);
  return example;
}

struct LossParts {
  torch::Tensor total, kinds, offsets, borders, jaw, directions;
};

LossParts loss_of(const ScanLogits& said, const ScanExample& is) {
  constexpr double offset_weight = 1, border_weight = 0.4, jaw_weight = 0.15, direction_weight = 0.5;
  LossParts loss;
  const torch::Tensor tooth = (is.kinds > 0).to(torch::kFloat);
  loss.kinds = torch::nll_loss(torch::log_softmax(said.each.slice(1, 0, scan_kind_count), 1), is.kinds);
  const torch::Tensor off = said.each.slice(1, scan_kind_count, scan_kind_count + 3) - is.middles;
  const torch::Tensor distance = (off.square().sum(1) + 1e-4).sqrt();
  loss.offsets = (distance * tooth).sum() / tooth.sum().clamp_min(1);
  loss.borders = torch::binary_cross_entropy_with_logits(said.each.select(1, scan_kind_count + 3), is.borders);
  loss.jaw = torch::binary_cross_entropy_with_logits(said.whole.slice(0, 0, 1), is.upper);
  loss.directions = (said.whole.slice(0, 1, scan_summary_count) - is.directions).square().sum();
  loss.total = loss.kinds + offset_weight * loss.offsets + border_weight * loss.borders + jaw_weight * loss.jaw +
               direction_weight * loss.directions;
  return loss;
}

/// What the loop's functions work on.
struct ScanTraining {
  ScanTraining(const CloudProvider& the_provider, const ScanTrainingOptions& the_options)
      : provider(the_provider), options(the_options) {
    torch::manual_seed(options.loop.seed);
    network = ScanNet(options.shape);
    parameters = network->parameters();
  }

  const LabelledCloud& scan(std::uint64_t index) {
    const auto found = kept.find(index);
    return found != kept.end() ? found->second : kept.emplace(index, provider(index)).first->second;
  }
  void prepare(std::uint64_t first, int count) {
    batch.clear();
    for (std::uint64_t i = first; i < first + static_cast<std::uint64_t>(count); ++i) {
      // Another order each time round.
      const std::uint64_t round = i / options.pool;
      RandomStream order(round, 71);
      const std::uint64_t index = (i + order.bits() % options.pool) % options.pool;
      batch[i] = &scan(index);
    }
  }
  TrainingShare share(std::uint64_t first, int count);
  Validation validate();

  const CloudProvider& provider;
  const ScanTrainingOptions& options;
  ScanNet network{nullptr};
  std::vector<torch::Tensor> parameters;
  std::map<std::uint64_t, LabelledCloud> kept;
  std::map<std::uint64_t, const LabelledCloud*> batch;
  ScanFigures best{.accuracy = -1};
};

TrainingShare ScanTraining::share(std::uint64_t first, int count) {
  TrainingShare share;
  for (std::uint64_t sample = first; sample < first + static_cast<std::uint64_t>(count); ++sample) {
    RandomStream random(options.loop.seed, 1000 + sample);
    const ScanExample example =
        to_example(varied(*batch.at(sample), options.shape, options.variation, random), options.shape);
    const LossParts loss = loss_of(network->forward(example.scan), example);
    add_gradients(torch::autograd::grad({loss.total}, parameters, {}, c10::nullopt, false, true), share.gradients);
    share.loss += loss.total.item<double>() / count;
    for (const auto& [name, part] :
         {std::pair("kinds", &loss.kinds), std::pair("offsets", &loss.offsets), std::pair("borders", &loss.borders),
          std::pair("jaw", &loss.jaw), std::pair("directions", &loss.directions)})
      share.terms[name] += part->item<double>() / count;
  }
  divide_gradients(share.gradients, count);
  return share;
}

Validation ScanTraining::validate() {
  ScanFigures f;
  const int count = options.loop.validation_samples;
  double points = 0, teeth = 0;
  for (int i = 0; i < count; ++i) {
    const auto number = static_cast<std::uint64_t>(i);
    RandomStream random(number, 72);
    const ScanExample example = to_example(
        varied(scan(first_validation_sample + number), options.shape, little_variation(), random), options.shape);
    const ScanLogits said = network->forward(example.scan);
    f.loss += loss_of(said, example).total.item<double>() / count;
    const torch::Tensor kinds = said.each.slice(1, 0, scan_kind_count).argmax(1);
    points += static_cast<double>(kinds.size(0));
    f.accuracy += (kinds == example.kinds).sum().item<double>();
    f.tooth_gum += ((kinds > 0) == (example.kinds > 0)).sum().item<double>();
    const torch::Tensor off = said.each.slice(1, scan_kind_count, scan_kind_count + 3) - example.middles;
    const torch::Tensor tooth = (example.kinds > 0).to(torch::kFloat);
    teeth += tooth.sum().item<double>();
    f.offset_mm += scan_offset_mm * (off.square().sum(1).sqrt() * tooth).sum().item<double>();
    f.jaw += ((said.whole[0] > 0).item<bool>() == (example.upper[0] > 0.5).item<bool>()) / static_cast<double>(count);
    const torch::Tensor front = said.whole.slice(0, 1, 4);
    const double cosine =
        torch::dot(front, example.directions.slice(0, 0, 3)).item<double>() / (front.norm().item<double>() + 1e-9);
    f.turn_deg += std::acos(std::clamp(cosine, -1.0, 1.0)) * 180 / std::numbers::pi / count;
  }
  f.accuracy /= std::max(points, 1.0);
  f.tooth_gum /= std::max(points, 1.0);
  f.offset_mm /= std::max(teeth, 1.0);
  if (f.accuracy > best.accuracy) best = f;
  Validation validation;
  validation.selection = f.accuracy;
  validation.figures = {{"loss", f.loss}, {"accuracy", f.accuracy},   {"tooth_gum", f.tooth_gum},
                        {"jaw", f.jaw},   {"offset_mm", f.offset_mm}, {"turn_deg", f.turn_deg}};
  validation.notes["validation.samples"] = std::to_string(count);
  for (const auto& [name, value] : validation.figures) validation.notes["validation." + name] = std::to_string(value);
  return validation;
}

}  // namespace

ScanTrainingResult train_scan(const CloudProvider& provider, const ScanTrainingOptions& options) {
  require_in_range(options);
  const TensorThreads one_thread(1);
  ScanTraining training(provider, options);
  TrainingTask task = task_of(training, options.pool);
  note_scan_shape(options.shape, task.identity);
  const TrainingLoopResult result = run_training_loop(*training.network, task, options.loop);
  return {result.steps, result.samples, training.best};
}

TensorFile export_scan(const std::filesystem::path& folder, const std::map<std::string, std::string>& notes) {
  TensorFile file = weights_of_run(folder, TensorType::float32, notes);
  read_scan_shape(file.metadata);  // weights of another network must not get out
  return file;
}

}  // namespace rhizodont
