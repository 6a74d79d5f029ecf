// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// Training of the completion network (Yu et al., AdaPoinTr, 2023; settings in learning/train_completion.hpp).
#include "learning/train_completion.hpp"

#include <algorithm>
#include <cstdio>
#include <numbers>

#include "base/option_range.hpp"
#include "learning/adapointr.hpp"
#include "learning/checkpoint.hpp"
#include "learning/completion_training_batch.hpp"
#include "learning/losses.hpp"
#include "learning/threads.hpp"
#include "learning/training_loop.hpp"
#include "learning/weights.hpp"
#include "networks/safetensors.hpp"
#include "rhizodont/error.hpp"

namespace rhizodont {
namespace {

constexpr double unit_mm = 12;

void require_in_range(const CompletionTrainingOptions& options) {
  check_shape(options.shape);
  require_in_range(options.loop);
  require_ranges("training", {{"unknown_share", options.unknown_share, share_range},
                              {"root_weight", options.root_weight, OptionRange::above(0)},
                              {"coarse_weight", options.coarse_weight, OptionRange::at_least(0)},
                              {"denoise_weight", options.denoise_weight, OptionRange::at_least(0)},
                              {"chamfer_weight", options.chamfer_weight, OptionRange::at_least(0)},
                              {"normal_weight", options.normal_weight, OptionRange::at_least(0)},
                              {"spread_weight", options.spread_weight, OptionRange::at_least(0)},
                              {"denoise_queries", options.denoise_queries, OptionRange::at_least(0)},
                              {"denoise_jitter", options.denoise_jitter, OptionRange::at_least(0)}});
}

/// What the loop's functions work on.
struct CompletionTraining {
  CompletionTraining(const CompletionSampleProvider& the_provider, const CompletionTrainingOptions& the_options)
      : provider(the_provider),
        options(the_options),
        precision(options.half_precision && layers::half_is_fast() ? layers::Precision::half
                                                                   : layers::Precision::single) {
    torch::manual_seed(options.loop.seed);
    network = AdaPoinTr(options.shape);
    parameters = network->parameters();
  }

  void begin();
  TrainingShare share(std::uint64_t first, int count);
  Validation validate();
  void store(TensorFile& checkpoint) const;
  void load(const TensorFile& checkpoint);
  void hand_round(const ProcessGroup& processes);

  const CompletionSampleProvider& provider;
  const CompletionTrainingOptions& options;
  layers::Precision precision;
  AdaPoinTr network{nullptr};
  std::vector<torch::Tensor> parameters;
  std::vector<PointLayout> layouts;
};

void CompletionTraining::begin() {
  QueryLayout layout = initial_layout(provider, options.shape);
  for (int type = 0; type <= unknown_type; ++type) {
    const auto& patches = layout.patches[static_cast<std::size_t>(type)];
    network->set_patches(type, patches.points, patches.normals);
  }
  layouts = std::move(layout.points);
}

TrainingShare CompletionTraining::share(std::uint64_t first, int count) {
  const CompletionTrainingBatch batch = make_completion_training_batch(provider, layouts, first, count, options, true);
  const Prediction prediction =
      network->forward(batch.crowns, batch.target.seeds, batch.target.seed_patches, precision);
  const LossTerms terms = completion_loss(prediction, batch.target, options);
  TrainingShare share;
  share.loss = terms.total.item<double>();
  share.terms = {{"coarse_mm", terms.coarse.item<double>() * unit_mm},
                 {"match_mm", terms.match.item<double>() * unit_mm},
                 {"chamfer_mm", terms.chamfer.item<double>() * unit_mm},
                 {"denoise_mm", terms.denoise.item<double>() * unit_mm},
                 {"normal", terms.normal.item<double>()},
                 {"spread", terms.spread.item<double>()}};
  share.gradients = torch::autograd::grad({terms.total}, parameters, {}, c10::nullopt, false, true);
  return share;
}

Validation CompletionTraining::validate() {
  double whole = 0, root = 0, length = 0, normal = 0;
  const int batch = std::min(options.loop.batch, options.loop.validation_samples);
  const int batches = options.loop.validation_samples / batch;
  for (int i = 0; i < batches; ++i) {
    const auto first = first_validation_sample + static_cast<std::uint64_t>(i * batch);
    const CompletionTrainingBatch samples =
        make_completion_training_batch(provider, layouts, first, batch, options, false);
    const Prediction prediction = network->forward(samples.crowns, {}, {}, precision);
    const TargetBatch& target = samples.target;
    const ClosestPoints closest = closest_points(prediction.fine, target.points);
    whole +=
        weighted_chamfer(prediction.fine, target.points, torch::ones_like(target.root), closest).mean().item<double>();
    root += weighted_chamfer(prediction.fine, target.points, target.root, closest).mean().item<double>();
    const torch::Tensor deepest = std::get<0>(prediction.fine.select(2, 2).min(1));
    length += (deepest - std::get<0>(target.points.select(2, 2).min(1))).abs().mean().item<double>();
    const torch::Tensor cosine =
        (prediction.normals * layers::gather_rows(target.normals, closest.first_to_second)).sum(-1).clamp(-1, 1);
    normal += torch::acos(cosine).mean().item<double>() * 180 / std::numbers::pi;
  }
  Validation validation;
  validation.selection = root / batches * unit_mm;
  validation.figures = {{"tooth_chamfer_l1_mm", whole / batches * unit_mm},
                        {"root_chamfer_l1_mm", validation.selection},
                        {"depth_error_mm", length / batches * unit_mm},
                        {"normal_error_degrees", normal / batches}};
  for (const auto& [name, value] : validation.figures) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3f", value);
    validation.notes["validation." + name] = text;
  }
  validation.notes["validation.samples"] = std::to_string(batches * batch);
  return validation;
}

void CompletionTraining::store(TensorFile& checkpoint) const {
  for (std::size_t type = 0; type < layouts.size(); ++type)
    checkpoint.tensors["layout." + std::to_string(type)] =
        store_integers(layouts[type], {static_cast<std::int64_t>(layouts[type].size())});
}

void CompletionTraining::load(const TensorFile& checkpoint) {
  layouts.clear();
  for (int type = 0; type < tooth_types; ++type) {
    const auto found = checkpoint.tensors.find("layout." + std::to_string(type));
    if (found == checkpoint.tensors.end() || found->second.type != TensorType::int32)
      throw InputError("The checkpoint in " + options.loop.folder.string() + " lacks the layout of the output.");
    layouts.push_back(load_integers(found->second));
  }
}

void CompletionTraining::hand_round(const ProcessGroup& processes) {
  layouts.resize(static_cast<std::size_t>(processes.share(static_cast<std::int64_t>(layouts.size()))));
  for (PointLayout& layout : layouts) {
    layout.resize(static_cast<std::size_t>(processes.share(static_cast<std::int64_t>(layout.size()))));
    if (!layout.empty())
      processes.share({torch::from_blob(layout.data(), {static_cast<std::int64_t>(layout.size())}, torch::kInt)});
  }
}

}  // namespace

CompletionTrainingResult train_completion(const CompletionSampleProvider& provider,
                                          const CompletionTrainingOptions& options) {
  require_in_range(options);
  const TensorThreads one_thread(1);
  CompletionTraining training(provider, options);
  TrainingTask task;
  note_shape(options.shape, task.identity);
  task.weight_type = TensorType::float16;
  task.lower_is_better = true;
  task.begin = [&] { training.begin(); };
  task.share = [&](std::uint64_t first, int count) { return training.share(first, count); };
  task.validate = [&] { return training.validate(); };
  task.store = [&](TensorFile& checkpoint) { training.store(checkpoint); };
  task.load = [&](const TensorFile& checkpoint) { training.load(checkpoint); };
  task.hand_round = [&](const ProcessGroup& processes) { training.hand_round(processes); };
  const TrainingLoopResult result = run_training_loop(*training.network, task, options.loop);
  return {result.steps, result.samples, result.last_loss, result.best};
}

TensorFile export_completion(const std::filesystem::path& folder, const std::map<std::string, std::string>& notes) {
  TensorFile file = weights_of_run(folder, TensorType::float16, notes);
  read_shape(file.metadata);  // weights of an older network must not get out
  return file;
}

}  // namespace rhizodont
