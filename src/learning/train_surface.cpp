// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// Training of surface networks (N. Sharp et al., DiffusionNet, 2022). Learning rate: linear warm-up and cosine decay
// (Loshchilov, Hutter: SGDR, 2017). Each thread takes its share of a batch; gradients are added in a fixed order.
#include "learning/train_surface.hpp"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <future>
#include <map>
#include <numbers>
#include <random>

#include "base/option_range.hpp"
#include "learning/checkpoint.hpp"
#include "learning/diffusion_net.hpp"
#include "learning/optimiser.hpp"
#include "learning/threads.hpp"
#include "learning/training_sample.hpp"
#include "learning/weights.hpp"
#include "networks/safetensors.hpp"
#include "rhizodont/error.hpp"

namespace rhizodont {
namespace {

using Clock = std::chrono::steady_clock;

double minutes_since(Clock::time_point then) { return std::chrono::duration<double>(Clock::now() - then).count() / 60; }

void require_in_range(const SurfaceTrainingOptions& options) {
  check_surface_shape(options.shape);
  require_ranges("training", {{"batch", options.batch, OptionRange::at_least(1)},
                              {"threads", options.threads, OptionRange::at_least(1).at_most(options.batch)},
                              {"samples", options.samples, OptionRange::at_least(1)},
                              {"pool", options.pool, OptionRange::at_least(1).below(first_validation_sample)},
                              {"hours", options.hours, OptionRange::at_least(0)},
                              {"learning_rate", options.learning_rate, OptionRange::above(0)},
                              {"lowest_rate", options.lowest_rate, share_range},
                              {"warm_up", options.warm_up, OptionRange::at_least(0)},
                              {"weight_decay", options.weight_decay, OptionRange::at_least(0)},
                              {"gradient_clip", options.gradient_clip, OptionRange::above(0)},
                              {"average_decay", options.average_decay, share_range},
                              {"tilt_radians", options.tilt_radians, OptionRange::at_least(0)},
                              {"scale_deviation", options.scale_deviation, OptionRange::at_least(0)},
                              {"validation_samples", options.validation_samples, OptionRange::at_least(0)},
                              {"validation_minutes", options.validation_minutes, OptionRange::at_least(0)},
                              {"checkpoint_minutes", options.checkpoint_minutes, OptionRange::at_least(0)},
                              {"log_steps", options.log_steps, OptionRange::at_least(1)}});
  if (options.batch % options.threads != 0) throw UsageError("The batch must be a multiple of the threads.");
}

double learning_rate(const SurfaceTrainingOptions& o, std::uint64_t step) {
  const auto now = static_cast<double>(step), warm_up = static_cast<double>(o.warm_up);
  if (now < warm_up) return o.learning_rate * (now + 1) / warm_up;
  const double last = static_cast<double>(o.samples) / o.batch;
  const double progress = std::clamp((now - warm_up) / std::max(last - warm_up, 1.0), 0.0, 1.0);
  return o.learning_rate * (o.lowest_rate + (1 - o.lowest_rate) * 0.5 * (1 + std::cos(std::numbers::pi * progress)));
}

/// Random numbers that depend on seed and sample alone, and not on the standard library's distributions.
class Draw {
 public:
  Draw(std::uint64_t seed, std::uint64_t sample) : engine_(seed * 0x9e3779b97f4a7c15ULL + sample) {}
  double uniform() { return static_cast<double>(engine_() >> 11) * 0x1.0p-53; }
  double normal() {
    const double radius = std::sqrt(-2 * std::log(1 - uniform()));
    return radius * std::cos(2 * std::numbers::pi * uniform());
  }

 private:
  std::mt19937_64 engine_;
};

/// The surface turned about z, tilted and scaled a little: operators and all other features stay as they are.
SurfaceTensors turned(const SurfaceTensors& surface, const SurfaceTrainingOptions& o, std::uint64_t sample) {
  Draw draw(o.seed, sample);
  const double angle = 2 * std::numbers::pi * draw.uniform(), c = std::cos(angle), s = std::sin(angle);
  const double a = o.tilt_radians * draw.normal(), b = o.tilt_radians * draw.normal();
  const double scale = std::exp(o.scale_deviation * draw.normal());
  const auto matrix = [](std::initializer_list<double> values) {
    return torch::tensor(std::vector<double>(values), torch::kDouble).view({3, 3});
  };
  const torch::Tensor turn =
      torch::matmul(torch::matmul(matrix({c, -s, 0, s, c, 0, 0, 0, 1}),
                                  matrix({1, 0, 0, 0, std::cos(a), -std::sin(a), 0, std::sin(a), std::cos(a)})),
                    matrix({std::cos(b), 0, std::sin(b), 0, 1, 0, -std::sin(b), 0, std::cos(b)}));
  const torch::Tensor transposed = turn.t().to(torch::kFloat);
  SurfaceTensors result = surface;
  result.features = surface.features.clone();
  for (const int at : {SurfaceFeature::position, SurfaceFeature::normal}) {
    const double factor = at == SurfaceFeature::position ? scale : 1;
    result.features.slice(1, at, at + 3)
        .copy_(factor * torch::matmul(surface.features.slice(1, at, at + 3), transposed));
  }
  return result;
}

/// Mean cross entropy by area.
torch::Tensor loss_of(const torch::Tensor& logits, const SurfaceTensors& surface) {
  const torch::Tensor each =
      torch::binary_cross_entropy_with_logits(logits, surface.labels, {}, {}, at::Reduction::None);
  const torch::Tensor mass = surface.mass.squeeze(1);
  return (each * mass).sum() / mass.sum();
}

/// Sums that figures are made of.
struct Counts {
  double loss = 0;
  std::uint64_t samples = 0, vertices = 0, right = 0, both = 0, either = 0;

  void add(const torch::Tensor& logits, const SurfaceTensors& surface) {
    const torch::Tensor said = logits < 0, is = surface.labels < 0.5;
    const auto count = [](const torch::Tensor& mask) {
      return static_cast<std::uint64_t>(mask.sum().item<std::int64_t>());
    };
    loss += loss_of(logits, surface).item<double>();
    ++samples;
    vertices += static_cast<std::uint64_t>(logits.size(0));
    right += count(said == is);
    both += count(said & is);
    either += count(said | is);
  }

  SurfaceFigures figures() const {
    SurfaceFigures f;
    f.vertices = vertices;
    f.loss = loss / static_cast<double>(std::max<std::uint64_t>(samples, 1));
    f.accuracy = static_cast<double>(right) / static_cast<double>(std::max<std::uint64_t>(vertices, 1));
    if (either > 0) f.intersection = static_cast<double>(both) / static_cast<double>(either);
    return f;
  }
};

/// Samples of the pool, made ahead by other threads and kept.
class Pool {
 public:
  Pool(const SurfaceProvider& provider, std::uint64_t size, std::size_t ahead)
      : provider_(provider), size_(size), ahead_(ahead) {}

  const SurfaceTensors& operator[](std::uint64_t sample) {
    const std::uint64_t index = sample % size_;
    for (std::uint64_t i = index; i < std::min(size_, index + 1 + ahead_); ++i)
      if (!kept_.contains(i) && !coming_.contains(i))
        coming_[i] = std::async(std::launch::async, [this, i] { return provider_(i); });
    if (const auto found = coming_.find(index); found != coming_.end()) {
      kept_[index] = to_tensors(found->second.get(), true);
      coming_.erase(found);
    }
    return kept_.at(index);
  }

 private:
  const SurfaceProvider& provider_;
  std::uint64_t size_;
  std::size_t ahead_;
  std::map<std::uint64_t, SurfaceTensors> kept_;
  std::map<std::uint64_t, std::future<SurfaceSample>> coming_;
};

class SurfaceTrainer {
 public:
  SurfaceTrainer(const SurfaceProvider& provider, const SurfaceTrainingOptions& options);
  SurfaceTrainingResult run();

 private:
  struct Share {
    std::vector<torch::Tensor> gradients;
    double loss = 0;
  };
  Share work(std::uint64_t first, const std::vector<SurfaceTensors>& surfaces) const;
  double step();
  void validate();
  void log(const std::string& line) const;
  void save_checkpoint() const;
  bool load_checkpoint();

  const SurfaceProvider& provider_;
  const SurfaceTrainingOptions& options_;
  mutable DiffusionNet network_;
  std::vector<torch::Tensor> parameters_;
  std::vector<TrainedTensor> tensors_;
  Pool pool_;
  std::vector<SurfaceTensors> held_out_;
  SurfaceTrainingResult result_;
};

SurfaceTrainer::SurfaceTrainer(const SurfaceProvider& provider, const SurfaceTrainingOptions& options)
    : provider_(provider), options_(options), network_(nullptr), pool_(provider, options.pool, 4) {
  torch::manual_seed(options.seed);
  network_ = DiffusionNet(options.shape);
  parameters_ = network_->parameters();
  tensors_ = trained_tensors(*network_);
  result_.best.intersection = -1;
  if (options.resume) load_checkpoint();
}

void SurfaceTrainer::log(const std::string& line) const {
  if (options_.log) options_.log(line);
}

SurfaceTrainer::Share SurfaceTrainer::work(std::uint64_t first, const std::vector<SurfaceTensors>& surfaces) const {
  const TensorThreads one_thread(1);  // counts per thread: this may be a fresh one
  Share share;
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    const SurfaceTensors surface = turned(surfaces[i], options_, first + i);
    const torch::Tensor loss = loss_of(network_->forward(surface), surface);
    const auto gradients = torch::autograd::grad({loss}, parameters_);
    share.loss += loss.item<double>();
    if (i == 0)
      share.gradients = gradients;
    else
      for (std::size_t p = 0; p < gradients.size(); ++p) share.gradients[p].add_(gradients[p]);
  }
  return share;
}

double SurfaceTrainer::step() {
  const auto threads = static_cast<std::uint64_t>(options_.threads);
  const std::uint64_t each = static_cast<std::uint64_t>(options_.batch) / threads;
  std::vector<std::vector<SurfaceTensors>> surfaces(threads);
  for (std::uint64_t i = 0; i < each * threads; ++i) surfaces[i / each].push_back(pool_[result_.samples + i]);
  std::vector<std::future<Share>> others;
  for (std::uint64_t t = 1; t < threads; ++t)
    others.push_back(std::async(std::launch::async, [&, t] { return work(result_.samples + t * each, surfaces[t]); }));
  Share sum = work(result_.samples, surfaces[0]);
  for (auto& other : others) {
    const Share share = other.get();
    for (std::size_t p = 0; p < sum.gradients.size(); ++p) sum.gradients[p].add_(share.gradients[p]);
    sum.loss += share.loss;
  }
  for (torch::Tensor& gradient : sum.gradients) gradient.div_(options_.batch);
  StepOptions step;
  step.learning_rate = learning_rate(options_, result_.steps);
  step.weight_decay = options_.weight_decay;
  step.clip = options_.gradient_clip;
  const auto done = static_cast<double>(result_.steps);
  step.average_decay = std::min(options_.average_decay, (1 + done) / (10 + done));
  step.step = static_cast<std::int64_t>(++result_.steps);
  adamw_step(tensors_, sum.gradients, step);
  result_.samples += static_cast<std::uint64_t>(options_.batch);
  return result_.last_loss = sum.loss / options_.batch;
}

void SurfaceTrainer::validate() {
  if (held_out_.empty())
    for (int i = 0; i < options_.validation_samples; ++i)
      held_out_.push_back(to_tensors(provider_(first_validation_sample + static_cast<std::uint64_t>(i)), true));
  torch::NoGradGuard no_gradient;
  std::vector<torch::Tensor> values;
  for (TrainedTensor& tensor : tensors_) {
    values.push_back(tensor.value.clone());
    tensor.value.copy_(tensor.average);
  }
  Counts counts;
  for (const SurfaceTensors& surface : held_out_) counts.add(network_->forward(surface), surface);
  for (std::size_t i = 0; i < tensors_.size(); ++i) tensors_[i].value.copy_(values[i]);
  const SurfaceFigures figures = counts.figures();
  const bool better = figures.intersection > result_.best.intersection;
  char line[200];
  std::snprintf(line, sizeof line, "held out: loss %.4f, accuracy %.4f, intersection over union %.4f%s", figures.loss,
                figures.accuracy, figures.intersection, better ? ", best so far" : "");
  log(line);
  if (!better) return;
  result_.best = figures;
  if (options_.folder.empty()) return;
  TensorFile file;
  for (const TrainedTensor& tensor : tensors_)
    file.tensors[tensor.name] = store_tensor(tensor.average, TensorType::float32);
  note_surface_shape(options_.shape, file.metadata);
  file.metadata["training.samples"] = std::to_string(result_.samples);
  file.metadata["training.steps"] = std::to_string(result_.steps);
  file.metadata["training.pool"] = std::to_string(options_.pool);
  file.metadata["training.seed"] = std::to_string(options_.seed);
  file.metadata["validation.samples"] = std::to_string(options_.validation_samples);
  file.metadata["validation.accuracy"] = std::to_string(figures.accuracy);
  file.metadata["validation.intersection_over_union"] = std::to_string(figures.intersection);
  write_safetensors(options_.folder / best_name, file);
}

void SurfaceTrainer::save_checkpoint() const {
  if (options_.folder.empty()) return;
  TensorFile file;
  store_progress(tensors_, {result_.samples, result_.steps, result_.best.intersection}, file);
  note_surface_shape(options_.shape, file.metadata);
  file.metadata["training.seed"] = std::to_string(options_.seed);
  write_safetensors(options_.folder / checkpoint_name, file);
}

bool SurfaceTrainer::load_checkpoint() {
  const std::filesystem::path path = options_.folder / checkpoint_name;
  if (!std::filesystem::exists(path)) return false;
  const TensorFile file = read_safetensors(path);
  std::map<std::string, std::string> wanted;
  note_surface_shape(options_.shape, wanted);
  wanted["training.seed"] = std::to_string(options_.seed);
  const TrainingProgress progress = load_progress(file, wanted, options_.folder, tensors_);
  result_.samples = progress.samples;
  result_.steps = progress.steps;
  result_.best.intersection = progress.best;
  log("going on from " + std::to_string(result_.samples) + " samples");
  return true;
}

SurfaceTrainingResult SurfaceTrainer::run() {
  const Clock::time_point start = Clock::now();
  Clock::time_point logged = start, saved = start, validated = start;
  double sum = 0;
  int steps = 0;
  while (result_.samples < options_.samples && (options_.hours <= 0 || minutes_since(start) < options_.hours * 60)) {
    sum += step();
    if (++steps == options_.log_steps) {
      char line[160];
      std::snprintf(line, sizeof line, "%llu samples, loss %.4f, %.1f samples/s",
                    static_cast<unsigned long long>(result_.samples), sum / steps,
                    steps * options_.batch / (60 * minutes_since(logged)));
      log(line);
      sum = 0;
      steps = 0;
      logged = Clock::now();
    }
    if (options_.validation_samples > 0 && minutes_since(validated) >= options_.validation_minutes) {
      validate();
      validated = logged = Clock::now();
      sum = 0;
      steps = 0;
    }
    if (minutes_since(saved) >= options_.checkpoint_minutes) {
      save_checkpoint();
      saved = Clock::now();
    }
  }
  if (options_.validation_samples > 0) validate();
  save_checkpoint();
  return result_;
}

}  // namespace

SurfaceTrainingResult train_surface(const SurfaceProvider& provider, const SurfaceTrainingOptions& options) {
  require_in_range(options);
  require_training_folder(options.folder, options.resume);
  const TensorThreads one_thread(1);
  return SurfaceTrainer(provider, options).run();
}

SurfaceFigures measure_surface(const SurfaceNetwork& network, const SurfaceProvider& provider, std::uint64_t first,
                               std::uint64_t count) {
  torch::NoGradGuard no_gradient;
  Counts counts;
  for (std::uint64_t i = first; i < first + count; ++i) {
    const SurfaceSample sample = provider(i);
    const SurfaceTensors surface = to_tensors(sample, true);
    const std::vector<float> confidence = network.confidence(sample);
    const torch::Tensor said = torch::tensor(confidence).clamp(1e-6, 1 - 1e-6);
    counts.add(torch::logit(said), surface);
  }
  return counts.figures();
}

TensorFile export_surface(const std::filesystem::path& folder, const std::map<std::string, std::string>& notes) {
  if (!std::filesystem::exists(folder / best_name))
    throw InputError("The folder " + folder.string() + " has no weights to export.");
  TensorFile file = read_safetensors(folder / best_name);
  read_surface_shape(file.metadata);  // weights of another network must not get out
  for (const auto& [key, text] : notes) file.metadata[key] = text;
  return file;
}

}  // namespace rhizodont
