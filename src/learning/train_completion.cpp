// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// Training of the completion network (Yu et al., AdaPoinTr, 2023; settings in learning/train_completion.hpp). Each
// thread takes its share of a batch through the network on its own and the gradients are added in a fixed order: on few
// cores this is faster than sharing each small operation, and the result does not depend on timing. Learning rate:
// linear warm-up and cosine decay (Loshchilov, Hutter: SGDR, 2017).
#include "learning/train_completion.hpp"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <future>
#include <numbers>
#include <optional>

#include "base/option_range.hpp"
#include "learning/adapointr.hpp"
#include "learning/checkpoint.hpp"
#include "learning/losses.hpp"
#include "learning/optimiser.hpp"
#include "learning/process_group.hpp"
#include "learning/threads.hpp"
#include "learning/training_batch.hpp"
#include "learning/weights.hpp"
#include "networks/safetensors.hpp"
#include "rhizodont/error.hpp"

namespace rhizodont {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double unit_mm = 12;

double minutes_since(Clock::time_point then) { return std::chrono::duration<double>(Clock::now() - then).count() / 60; }

/// The terms of a loss as numbers, summed or averaged over steps.
struct Figures {
  double total = 0, coarse = 0, match = 0, chamfer = 0, denoise = 0, normal = 0, spread = 0, gradient = 0;

  Figures& operator+=(const Figures& other) {
    total += other.total;
    coarse += other.coarse;
    match += other.match;
    chamfer += other.chamfer;
    denoise += other.denoise;
    normal += other.normal;
    spread += other.spread;
    gradient += other.gradient;
    return *this;
  }
};

Figures to_figures(const LossTerms& terms) {
  return {terms.total.item<double>(),   terms.coarse.item<double>(),
          terms.match.item<double>(),   terms.chamfer.item<double>(),
          terms.denoise.item<double>(), terms.normal.item<double>(),
          terms.spread.item<double>(),  0};
}

/// What one thread brings back from its share of a batch.
struct Share {
  std::vector<torch::Tensor> gradients;
  Figures figures;
};

void require_in_range(const TrainingOptions& options) {
  check_shape(options.shape);
  require_in_range(options.processes);
  require_ranges("training", {{"batch", options.batch, OptionRange::at_least(1)},
                              {"threads", options.threads, OptionRange::at_least(1).at_most(options.batch)},
                              {"samples", options.samples, OptionRange::at_least(1)},
                              {"hours", options.hours, OptionRange::at_least(0)},
                              {"learning_rate", options.learning_rate, OptionRange::above(0)},
                              {"lowest_rate", options.lowest_rate, share_range},
                              {"warm_up", options.warm_up, OptionRange::at_least(0)},
                              {"weight_decay", options.weight_decay, OptionRange::at_least(0)},
                              {"gradient_clip", options.gradient_clip, OptionRange::above(0)},
                              {"average_decay", options.average_decay, share_range},
                              {"unknown_share", options.unknown_share, share_range},
                              {"root_weight", options.root_weight, OptionRange::above(0)},
                              {"coarse_weight", options.coarse_weight, OptionRange::at_least(0)},
                              {"denoise_weight", options.denoise_weight, OptionRange::at_least(0)},
                              {"chamfer_weight", options.chamfer_weight, OptionRange::at_least(0)},
                              {"normal_weight", options.normal_weight, OptionRange::at_least(0)},
                              {"spread_weight", options.spread_weight, OptionRange::at_least(0)},
                              {"denoise_queries", options.denoise_queries, OptionRange::at_least(0)},
                              {"denoise_jitter", options.denoise_jitter, OptionRange::at_least(0)},
                              {"validation_samples", options.validation_samples, OptionRange::at_least(0)},
                              {"validation_minutes", options.validation_minutes, OptionRange::at_least(0)},
                              {"checkpoint_minutes", options.checkpoint_minutes, OptionRange::at_least(0)},
                              {"log_steps", options.log_steps, OptionRange::at_least(1)}});
  if (options.batch % options.threads != 0) throw UsageError("The batch must be a multiple of the threads.");
}

double learning_rate(const TrainingOptions& o, std::uint64_t step) {
  const auto now = static_cast<double>(step), warm_up = static_cast<double>(o.warm_up);
  if (now < warm_up) return o.learning_rate * (now + 1) / warm_up;
  const double last = static_cast<double>(o.samples) / (o.batch * o.processes.count);
  const double progress = std::clamp((now - warm_up) / std::max(last - warm_up, 1.0), 0.0, 1.0);
  return o.learning_rate * (o.lowest_rate + (1 - o.lowest_rate) * 0.5 * (1 + std::cos(std::numbers::pi * progress)));
}

class Trainer {
 public:
  Trainer(const SampleProvider& provider, const TrainingOptions& options);
  TrainingResult run();

 private:
  Share work(std::uint64_t first) const;
  Figures step();
  void log(const std::string& line) const;
  void log_progress(const Figures& sum, std::uint64_t steps, double minutes) const;
  void validate();
  void save_checkpoint() const;
  bool load_checkpoint();
  void load_start();
  void save_best(const std::map<std::string, std::string>& figures) const;
  void share_state();

  const SampleProvider& provider_;
  const TrainingOptions& options_;
  ProcessGroup processes_;
  layers::Precision precision_;
  mutable AdaPoinTr network_;
  std::vector<torch::Tensor> parameters_;
  std::vector<TrainedTensor> tensors_;
  std::vector<PointLayout> layouts_;
  TrainingResult result_;
};

Trainer::Trainer(const SampleProvider& provider, const TrainingOptions& options)
    : provider_(provider),
      options_(options),
      processes_(options.processes),
      precision_(options.half_precision && layers::half_is_fast() ? layers::Precision::half
                                                                  : layers::Precision::single),
      network_(nullptr) {
  torch::manual_seed(options.seed);
  network_ = AdaPoinTr(options.shape);
  parameters_ = network_->parameters();
  tensors_ = trained_tensors(*network_);
  const bool resumed = processes_.share(options.resume && processes_.is_first() && load_checkpoint() ? 1 : 0) == 1;
  if (resumed) {
    share_state();
    return;
  }
  if (!options.start_from.empty()) load_start();
  QueryLayout layout = initial_layout(provider, options.shape);
  for (int type = 0; type <= unknown_type; ++type) {
    const auto& patches = layout.patches[static_cast<std::size_t>(type)];
    network_->set_patches(type, patches.points, patches.normals);
  }
  layouts_ = std::move(layout.points);
  for (TrainedTensor& tensor : tensors_) tensor.average.copy_(tensor.value);
  share_state();
}

/// All processes go on from where the first one is.
void Trainer::share_state() {
  for (TrainedTensor& tensor : tensors_) processes_.share({tensor.value, tensor.mean, tensor.square, tensor.average});
  result_.samples = static_cast<std::uint64_t>(processes_.share(static_cast<std::int64_t>(result_.samples)));
  result_.steps = static_cast<std::uint64_t>(processes_.share(static_cast<std::int64_t>(result_.steps)));
  layouts_.resize(static_cast<std::size_t>(processes_.share(static_cast<std::int64_t>(layouts_.size()))));
  for (PointLayout& layout : layouts_) {
    layout.resize(static_cast<std::size_t>(processes_.share(static_cast<std::int64_t>(layout.size()))));
    if (!layout.empty())
      processes_.share({torch::from_blob(layout.data(), {static_cast<std::int64_t>(layout.size())}, torch::kInt)});
  }
}

void Trainer::log(const std::string& line) const {
  if (options_.log && processes_.is_first()) options_.log(line);
}

/// Loss and gradients of samples `first` .. `first + batch / threads - 1`.
Share Trainer::work(std::uint64_t first) const {
  const TensorThreads one_thread(1);  // counts per thread: this may be a fresh one
  const TrainingBatch batch =
      make_training_batch(provider_, layouts_, first, options_.batch / options_.threads, options_, true);
  const Prediction prediction =
      network_->forward(batch.crowns, batch.target.seeds, batch.target.seed_patches, precision_);
  const LossTerms terms = training_loss(prediction, batch.target, options_);
  Share share;
  share.figures = to_figures(terms);
  share.gradients = torch::autograd::grad({terms.total}, parameters_, {}, c10::nullopt, false, true);
  return share;
}

Figures Trainer::step() {
  const auto threads = static_cast<std::uint64_t>(options_.threads);
  const std::uint64_t each = static_cast<std::uint64_t>(options_.batch) / threads;
  const auto batch = static_cast<std::uint64_t>(options_.batch), count = static_cast<std::uint64_t>(processes_.size());
  const std::uint64_t first = result_.samples + batch * static_cast<std::uint64_t>(processes_.rank());
  std::vector<std::future<Share>> others;
  for (std::uint64_t t = 1; t < threads; ++t)
    others.push_back(std::async(std::launch::async, [&, t] { return work(first + t * each); }));
  Share sum = work(first);
  for (auto& other : others) {
    const Share share = other.get();
    for (std::size_t i = 0; i < sum.gradients.size(); ++i) {
      if (sum.gradients[i].defined()) sum.gradients[i].add_(share.gradients[i]);
    }
    sum.figures += share.figures;
  }
  std::vector<torch::Tensor> own;
  for (const torch::Tensor& gradient : sum.gradients)
    if (gradient.defined()) own.push_back(gradient);
  processes_.sum(own);
  // Figures are of this process's samples alone.
  const double scale = 1 / static_cast<double>(threads), gradient_scale = scale / static_cast<double>(count);
  for (torch::Tensor& gradient : sum.gradients) {
    if (gradient.defined() && gradient_scale != 1) gradient.mul_(gradient_scale);
  }
  StepOptions step;
  step.learning_rate = learning_rate(options_, result_.steps);
  step.weight_decay = options_.weight_decay;
  step.clip = options_.gradient_clip;
  // Early on, the running mean forgets the start as fast as it can.
  const auto done = static_cast<double>(result_.steps);
  step.average_decay = std::min(options_.average_decay, (1 + done) / (10 + done));
  step.step = static_cast<std::int64_t>(result_.steps) + 1;
  Figures figures = sum.figures;
  for (double* value : {&figures.total, &figures.coarse, &figures.match, &figures.chamfer, &figures.denoise,
                        &figures.normal, &figures.spread})
    *value *= scale;
  figures.gradient = adamw_step(tensors_, sum.gradients, step);
  ++result_.steps;
  result_.samples += batch * count;
  result_.last_loss = figures.total;
  return figures;
}

void Trainer::log_progress(const Figures& sum, std::uint64_t steps, double minutes) const {
  char line[320];
  const auto n = static_cast<double>(steps);
  std::snprintf(line, sizeof line,
                "step %llu samples %llu loss %.4f coarse %.3f mm match %.3f mm chamfer %.3f mm denoise %.3f mm normal "
                "%.4f spread %.3f gradient %.2f "
                "rate %.2e %.1f samples/s",
                static_cast<unsigned long long>(result_.steps), static_cast<unsigned long long>(result_.samples),
                sum.total / n, sum.coarse / n * unit_mm, sum.match / n * unit_mm, sum.chamfer / n * unit_mm,
                sum.denoise / n * unit_mm, sum.normal / n, sum.spread / n, sum.gradient / n,
                learning_rate(options_, result_.steps - 1), n * options_.batch * processes_.size() / (minutes * 60));
  log(line);
}

/// Figures of the running mean of the weights on held-out samples.
void Trainer::validate() {
  torch::NoGradGuard no_gradient;
  for (TrainedTensor& tensor : tensors_) {
    const torch::Tensor current = tensor.value.clone();
    tensor.value.copy_(tensor.average);
    tensor.average.copy_(current);
  }
  double whole = 0, root = 0, length = 0, normal = 0;
  const int batch = std::min(options_.batch, options_.validation_samples);
  const int batches = options_.validation_samples / batch;
  for (int i = 0; i < batches; ++i) {
    const auto first = first_validation_sample + static_cast<std::uint64_t>(i * batch);
    const TrainingBatch samples = make_training_batch(provider_, layouts_, first, batch, options_, false);
    const Prediction prediction = network_->forward(samples.crowns, {}, {}, precision_);
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
  for (TrainedTensor& tensor : tensors_) {
    const torch::Tensor averaged = tensor.value.clone();
    tensor.value.copy_(tensor.average);
    tensor.average.copy_(averaged);
  }
  const double root_mm = root / batches * unit_mm;
  std::map<std::string, std::string> figures;
  const auto note = [&](const char* name, double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3f", value);
    figures[name] = text;
  };
  note("validation.tooth_chamfer_l1_mm", whole / batches * unit_mm);
  note("validation.root_chamfer_l1_mm", root_mm);
  note("validation.depth_error_mm", length / batches * unit_mm);
  note("validation.normal_error_degrees", normal / batches);
  figures["validation.samples"] = std::to_string(batches * batch);
  const bool better = result_.best_root_chamfer < 0 || root_mm < result_.best_root_chamfer;
  log("validation at " + std::to_string(result_.samples) + " samples: tooth " +
      figures["validation.tooth_chamfer_l1_mm"] + " mm, root " + figures["validation.root_chamfer_l1_mm"] +
      " mm, depth error " + figures["validation.depth_error_mm"] + " mm, normals " +
      figures["validation.normal_error_degrees"] + " degrees" + (better ? ", best so far" : ""));
  if (!better) return;
  result_.best_root_chamfer = root_mm;
  save_best(figures);
}

void Trainer::save_best(const std::map<std::string, std::string>& figures) const {
  if (options_.folder.empty()) return;
  TensorFile file;
  for (const TrainedTensor& tensor : tensors_)
    file.tensors[tensor.name] = store_tensor(tensor.average, TensorType::float16);
  file.metadata = figures;
  note_shape(options_.shape, file.metadata);
  file.metadata["training.samples"] = std::to_string(result_.samples);
  file.metadata["training.steps"] = std::to_string(result_.steps);
  file.metadata["training.seed"] = std::to_string(options_.seed);
  write_safetensors(options_.folder / best_name, file);
}

void Trainer::save_checkpoint() const {
  if (options_.folder.empty()) return;
  TensorFile file;
  store_progress(tensors_, {result_.samples, result_.steps, result_.best_root_chamfer}, file);
  for (std::size_t type = 0; type < layouts_.size(); ++type)
    file.tensors["layout." + std::to_string(type)] =
        store_integers(layouts_[type], {static_cast<std::int64_t>(layouts_[type].size())});
  note_shape(options_.shape, file.metadata);
  file.metadata["training.seed"] = std::to_string(options_.seed);
  write_safetensors(options_.folder / checkpoint_name, file);
}

void Trainer::load_start() {
  const TensorFile file = read_safetensors(options_.start_from);
  std::map<std::string, std::string> own, theirs;
  note_shape(options_.shape, own);
  note_shape(read_shape(file.metadata), theirs);
  if (own != theirs) throw InputError("The weights to start from are of a network of other sizes.");
  for (TrainedTensor& tensor : tensors_) load_tensor(file, tensor.name, tensor.value);
}

bool Trainer::load_checkpoint() {
  const std::filesystem::path path = options_.folder / checkpoint_name;
  if (!std::filesystem::exists(path)) return false;
  const TensorFile file = read_safetensors(path);
  std::map<std::string, std::string> wanted;
  note_shape(options_.shape, wanted);
  wanted["training.seed"] = std::to_string(options_.seed);
  const TrainingProgress progress = load_progress(file, wanted, options_.folder, tensors_);
  for (int type = 0; type < tooth_types; ++type) {
    const auto found = file.tensors.find("layout." + std::to_string(type));
    if (found == file.tensors.end() || found->second.type != TensorType::int32)
      throw InputError("The checkpoint in " + options_.folder.string() + " lacks the layout of the output.");
    layouts_.push_back(load_integers(found->second));
  }
  result_.samples = progress.samples;
  result_.steps = progress.steps;
  result_.best_root_chamfer = progress.best;
  log("going on from " + std::to_string(result_.samples) + " samples");
  return true;
}

TrainingResult Trainer::run() {
  const Clock::time_point start = Clock::now();
  Clock::time_point logged = start, saved = start, validated = start;
  Figures sum;
  std::uint64_t steps = 0;
  double outside = 0;  // minutes since the last line that were not training
  const auto goes_on = [&] {
    const bool wanted =
        result_.samples < options_.samples && (options_.hours <= 0 || minutes_since(start) < options_.hours * 60);
    return processes_.share(wanted ? 1 : 0) == 1;  // clocks differ, and nobody must wait for one who has stopped
  };
  while (goes_on()) {
    sum += step();
    if (++steps == static_cast<std::uint64_t>(options_.log_steps)) {
      log_progress(sum, steps, minutes_since(logged) - outside);
      sum = {};
      steps = 0;
      outside = 0;
      logged = Clock::now();
    }
    if (!processes_.is_first()) continue;
    const Clock::time_point pause = Clock::now();
    if (options_.validation_samples > 0 && minutes_since(validated) >= options_.validation_minutes) {
      validate();
      validated = Clock::now();
    }
    if (minutes_since(saved) >= options_.checkpoint_minutes) {
      save_checkpoint();
      saved = Clock::now();
    }
    outside += minutes_since(pause);
  }
  if (!processes_.is_first()) return result_;
  if (options_.validation_samples > 0) validate();
  save_checkpoint();
  return result_;
}

}  // namespace

TrainingResult train_completion(const SampleProvider& provider, const TrainingOptions& options) {
  require_in_range(options);
  require_training_folder(options.folder, options.resume);
  // OpenMP's threads would wait in busy loops between the few moments when they have work.
  const TensorThreads one_thread(1);
  return Trainer(provider, options).run();
}

TensorFile export_completion(const std::filesystem::path& folder, const std::map<std::string, std::string>& notes) {
  TensorFile file;
  if (std::filesystem::exists(folder / best_name)) {
    file = read_safetensors(folder / best_name);
  } else if (std::filesystem::exists(folder / checkpoint_name)) {
    const TensorFile checkpoint = read_safetensors(folder / checkpoint_name);
    const std::string prefix = "average.";
    for (const auto& [name, tensor] : checkpoint.tensors) {
      if (name.starts_with(prefix))
        file.tensors[name.substr(prefix.size())] = store_floats(load_floats(tensor), tensor.shape, TensorType::float16);
    }
    file.metadata = checkpoint.metadata;
  } else {
    throw InputError("The folder " + folder.string() + " has no weights to export.");
  }
  read_shape(file.metadata);  // weights of an older network must not get out
  for (const auto& [key, text] : notes) file.metadata[key] = text;
  return file;
}

}  // namespace rhizodont
