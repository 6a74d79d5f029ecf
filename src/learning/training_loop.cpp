// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// Each thread takes its share of a batch through the network on its own and the gradients are added in a fixed order:
// on few cores this is faster than sharing each small operation, and the result does not depend on timing. Learning
// rate: linear warm-up and cosine decay (Loshchilov, Hutter: SGDR, 2017).
#include "learning/training_loop.hpp"

#include <algorithm>
#include <cmath>
#include <future>
#include <numbers>

#include "base/option_range.hpp"
#include "base/stopwatch.hpp"
#include "learning/checkpoint.hpp"
#include "learning/optimiser.hpp"
#include "learning/threads.hpp"
#include "learning/weights.hpp"
#include "rhizodont/error.hpp"

namespace rhizodont {
namespace {

double minutes(const Stopwatch& watch) { return watch.seconds() / 60; }

void add(TrainingShare& sum, const TrainingShare& share) {
  for (std::size_t i = 0; i < sum.gradients.size(); ++i) {
    if (!share.gradients[i].defined()) continue;
    if (sum.gradients[i].defined())
      sum.gradients[i].add_(share.gradients[i]);
    else
      sum.gradients[i] = share.gradients[i];
  }
  sum.loss += share.loss;
  for (const auto& [name, value] : share.terms) sum.terms[name] += value;
}

/// Sums since the last report.
struct Tally {
  int steps = 0;
  double loss = 0, gradient_norm = 0;
  std::map<std::string, double> terms;
};

class TrainingLoop {
 public:
  TrainingLoop(const torch::nn::Module& network, const TrainingTask& task, const TrainingLoopOptions& options);
  TrainingLoopResult run();

 private:
  TrainingShare share(std::uint64_t first) const;
  TrainingShare batch(std::uint64_t first) const;
  void average_over_processes(TrainingShare& mean) const;
  void step();
  void report(TrainingProgress progress) const;
  void report_steps(double minutes);
  void validate();
  void swap_with_average();
  void save_best(const Validation& validation) const;
  void save_checkpoint() const;
  bool load_checkpoint();
  void load_start();
  void share_state();

  const TrainingTask& task_;
  const TrainingLoopOptions& options_;
  ProcessGroup processes_;
  std::vector<TrainedTensor> tensors_;
  TrainingLoopResult result_;
  Tally tally_;
};

TrainingLoop::TrainingLoop(const torch::nn::Module& network, const TrainingTask& task,
                           const TrainingLoopOptions& options)
    : task_(task), options_(options), processes_(options.processes), tensors_(trained_tensors(network)) {
  const bool resumed = processes_.share(options.resume && processes_.is_first() && load_checkpoint() ? 1 : 0) == 1;
  if (!resumed) {
    if (!options.start_from.empty()) load_start();
    if (task.begin) task.begin();
    for (TrainedTensor& tensor : tensors_) tensor.average.copy_(tensor.value);
  }
  share_state();
}

/// All processes go on from where the first one is.
void TrainingLoop::share_state() {
  for (TrainedTensor& tensor : tensors_) processes_.share({tensor.value, tensor.mean, tensor.square, tensor.average});
  result_.samples = static_cast<std::uint64_t>(processes_.share(static_cast<std::int64_t>(result_.samples)));
  result_.steps = static_cast<std::uint64_t>(processes_.share(static_cast<std::int64_t>(result_.steps)));
  if (task_.hand_round) task_.hand_round(processes_);
}

void TrainingLoop::report(TrainingProgress progress) const {
  if (!options_.progress || !processes_.is_first()) return;
  progress.steps = result_.steps;
  progress.samples = result_.samples;
  options_.progress(progress);
}

TrainingShare TrainingLoop::share(std::uint64_t first) const {
  const TensorThreads one_thread(1);  // counts per thread: this may be a fresh one
  return task_.share(first, options_.batch / options_.threads);
}

/// Mean over the samples `first` .. `first + batch - 1`.
TrainingShare TrainingLoop::batch(std::uint64_t first) const {
  const auto threads = static_cast<std::uint64_t>(options_.threads);
  const std::uint64_t each = static_cast<std::uint64_t>(options_.batch) / threads;
  std::vector<std::future<TrainingShare>> others;
  for (std::uint64_t t = 1; t < threads; ++t)
    others.push_back(std::async(std::launch::async, [&, t] { return share(first + t * each); }));
  TrainingShare mean = share(first);
  for (auto& other : others) add(mean, other.get());
  const double scale = 1 / static_cast<double>(threads);
  mean.loss *= scale;
  for (auto& [name, value] : mean.terms) value *= scale;
  return mean;
}

/// Gradients, which are sums over threads so far, and the loss.
void TrainingLoop::average_over_processes(TrainingShare& mean) const {
  std::vector<torch::Tensor> own;
  for (const torch::Tensor& gradient : mean.gradients)
    if (gradient.defined()) own.push_back(gradient);
  processes_.sum(own);
  const double scale = 1 / static_cast<double>(options_.threads) / processes_.size();
  for (torch::Tensor& gradient : own) {
    if (scale != 1) gradient.mul_(scale);
  }
  // Summed too, so that a loss that is no number ends all processes at once.
  const torch::Tensor loss = torch::full({1}, mean.loss, torch::kDouble);
  processes_.sum({loss});
  mean.loss = loss.item<double>() / processes_.size();
}

void TrainingLoop::step() {
  const auto batch_size = static_cast<std::uint64_t>(options_.batch),
             processes = static_cast<std::uint64_t>(processes_.size());
  const std::uint64_t first = result_.samples + batch_size * static_cast<std::uint64_t>(processes_.rank());
  if (task_.prepare) task_.prepare(first, options_.batch);
  TrainingShare mean = batch(first);
  average_over_processes(mean);
  if (!std::isfinite(mean.loss)) throw NoResultError("Training came to a loss that is not a number.");
  StepOptions step;
  step.learning_rate = learning_rate_at(options_, result_.steps);
  step.weight_decay = options_.weight_decay;
  step.clip = options_.gradient_clip;
  // Early on, the running mean forgets the start as fast as it can.
  const auto done = static_cast<double>(result_.steps);
  step.average_decay = std::min(options_.average_decay, (1 + done) / (10 + done));
  step.step = static_cast<std::int64_t>(result_.steps) + 1;
  tally_.gradient_norm += adamw_step(tensors_, mean.gradients, step);
  tally_.loss += mean.loss;
  for (const auto& [name, value] : mean.terms) tally_.terms[name] += value;
  ++tally_.steps;
  ++result_.steps;
  result_.samples += batch_size * processes;
  result_.last_loss = mean.loss;
}

void TrainingLoop::report_steps(double minutes) {
  const auto steps = static_cast<double>(tally_.steps);
  TrainingProgress progress;
  progress.event = TrainingEvent::steps;
  progress.loss = tally_.loss / steps;
  progress.gradient_norm = tally_.gradient_norm / steps;
  progress.terms = tally_.terms;
  for (auto& [name, value] : progress.terms) value /= steps;
  progress.learning_rate = learning_rate_at(options_, result_.steps - 1);
  progress.samples_per_second = steps * options_.batch * processes_.size() / std::max(minutes * 60, 1e-9);
  report(progress);
  tally_ = {};
}

void TrainingLoop::swap_with_average() {
  for (TrainedTensor& tensor : tensors_) {
    const torch::Tensor value = tensor.value.clone();
    tensor.value.copy_(tensor.average);
    tensor.average.copy_(value);
  }
}

/// Figures of the running mean of the weights on held-out samples.
void TrainingLoop::validate() {
  torch::NoGradGuard no_gradient;
  swap_with_average();
  const Validation validation = task_.validate();
  swap_with_average();
  TrainingProgress progress;
  progress.event = TrainingEvent::validation;
  progress.validation = validation.figures;
  progress.is_best = result_.best < 0 || (task_.lower_is_better ? validation.selection < result_.best
                                                                : validation.selection > result_.best);
  if (progress.is_best) {
    result_.best = validation.selection;
    save_best(validation);
  }
  report(progress);
}

void TrainingLoop::save_best(const Validation& validation) const {
  if (options_.folder.empty()) return;
  TensorFile file;
  for (const TrainedTensor& tensor : tensors_)
    file.tensors[tensor.name] = store_tensor(tensor.average, task_.weight_type);
  file.metadata = validation.notes;
  for (const auto* notes : {&task_.identity, &task_.notes})
    for (const auto& [key, text] : *notes) file.metadata[key] = text;
  file.metadata["training.samples"] = std::to_string(result_.samples);
  file.metadata["training.steps"] = std::to_string(result_.steps);
  file.metadata["training.seed"] = std::to_string(options_.seed);
  write_safetensors(options_.folder / best_name, file);
}

void TrainingLoop::save_checkpoint() const {
  if (options_.folder.empty()) return;
  TensorFile file;
  store_progress(tensors_, {result_.samples, result_.steps, result_.best}, file);
  if (task_.store) task_.store(file);
  for (const auto& [key, text] : task_.identity) file.metadata[key] = text;
  file.metadata["training.seed"] = std::to_string(options_.seed);
  write_safetensors(options_.folder / checkpoint_name, file);
}

bool TrainingLoop::load_checkpoint() {
  const std::filesystem::path path = options_.folder / checkpoint_name;
  if (!std::filesystem::exists(path)) return false;
  const TensorFile file = read_safetensors(path);
  std::map<std::string, std::string> wanted = task_.identity;
  wanted["training.seed"] = std::to_string(options_.seed);
  const CheckpointProgress progress = load_progress(file, wanted, options_.folder, tensors_);
  if (task_.load) task_.load(file);
  result_.samples = progress.samples;
  result_.steps = progress.steps;
  result_.best = progress.best;
  TrainingProgress resumed;
  resumed.event = TrainingEvent::resumed;
  report(resumed);
  return true;
}

void TrainingLoop::load_start() {
  const TensorFile file = read_safetensors(options_.start_from);
  for (const auto& [key, text] : task_.identity) {
    const auto found = file.metadata.find(key);
    if (found == file.metadata.end() || found->second != text)
      throw InputError("The weights to start from are of another network: \"" + key + "\" is not \"" + text + "\".");
  }
  for (TrainedTensor& tensor : tensors_) load_tensor(file, tensor.name, tensor.value);
}

TrainingLoopResult TrainingLoop::run() {
  const Stopwatch whole;
  Stopwatch reported, saved, validated;
  double outside = 0;  // minutes since the last report that were not training
  const bool validates = options_.validation_samples > 0 && task_.validate;
  const auto goes_on = [&] {
    const bool wanted =
        result_.samples < options_.samples && (options_.hours <= 0 || minutes(whole) < options_.hours * 60);
    return processes_.share(wanted ? 1 : 0) == 1;  // clocks differ, and nobody must wait for one who has stopped
  };
  while (goes_on()) {
    step();
    if (tally_.steps == options_.report_steps) {
      report_steps(minutes(reported) - outside);
      outside = 0;
      reported.restart();
    }
    if (!processes_.is_first()) continue;
    const Stopwatch pause;
    if (validates && minutes(validated) >= options_.validation_minutes) {
      validate();
      validated.restart();
    }
    if (minutes(saved) >= options_.checkpoint_minutes) {
      save_checkpoint();
      saved.restart();
    }
    outside += minutes(pause);
  }
  if (!processes_.is_first()) return result_;
  if (validates) validate();
  save_checkpoint();
  return result_;
}

}  // namespace

void require_in_range(const TrainingLoopOptions& options) {
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
                              {"validation_samples", options.validation_samples, OptionRange::at_least(0)},
                              {"validation_minutes", options.validation_minutes, OptionRange::at_least(0)},
                              {"checkpoint_minutes", options.checkpoint_minutes, OptionRange::at_least(0)},
                              {"report_steps", options.report_steps, OptionRange::at_least(1)}});
  if (options.batch % options.threads != 0) throw UsageError("The batch must be a multiple of the threads.");
}

double learning_rate_at(const TrainingLoopOptions& o, std::uint64_t step) {
  const auto now = static_cast<double>(step), warm_up = static_cast<double>(o.warm_up);
  if (now < warm_up) return o.learning_rate * (now + 1) / warm_up;
  const double last = static_cast<double>(o.samples) / (o.batch * o.processes.count);
  const double progress = std::clamp((now - warm_up) / std::max(last - warm_up, 1.0), 0.0, 1.0);
  return o.learning_rate * (o.lowest_rate + (1 - o.lowest_rate) * 0.5 * (1 + std::cos(std::numbers::pi * progress)));
}

void add_gradients(const std::vector<torch::Tensor>& of_sample, std::vector<torch::Tensor>& of_share) {
  of_share.resize(of_sample.size());
  for (std::size_t p = 0; p < of_sample.size(); ++p) {
    if (!of_sample[p].defined()) continue;
    if (of_share[p].defined())
      of_share[p].add_(of_sample[p]);
    else
      of_share[p] = of_sample[p];
  }
}

void divide_gradients(std::vector<torch::Tensor>& of_share, int count) {
  for (torch::Tensor& gradient : of_share)
    if (gradient.defined()) gradient.div_(count);
}

TrainingLoopResult run_training_loop(const torch::nn::Module& network, const TrainingTask& task,
                                     const TrainingLoopOptions& options) {
  require_in_range(options);
  require_training_folder(options.folder, options.resume);
  // OpenMP's threads would wait in busy loops between the few moments when they have work.
  const TensorThreads one_thread(1);
  return TrainingLoop(network, task, options).run();
}

}  // namespace rhizodont
