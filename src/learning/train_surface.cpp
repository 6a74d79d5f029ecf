// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// Training of surface networks (N. Sharp et al., DiffusionNet, 2022).
#include "learning/train_surface.hpp"

#include <cmath>
#include <future>
#include <map>
#include <numbers>
#include <random>

#include "base/option_range.hpp"
#include "learning/checkpoint.hpp"
#include "learning/diffusion_net.hpp"
#include "learning/threads.hpp"
#include "learning/training_loop.hpp"
#include "rhizodont/error.hpp"

namespace rhizodont {
namespace {

void require_in_range(const SurfaceTrainingOptions& options) {
  check_surface_shape(options.shape);
  require_in_range(options.loop);
  require_ranges("training", {{"pool", options.pool, OptionRange::at_least(1).below(first_validation_sample)},
                              {"tilt_radians", options.tilt_radians, OptionRange::at_least(0)},
                              {"scale_deviation", options.scale_deviation, OptionRange::at_least(0)}});
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
  Draw draw(o.loop.seed, sample);
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

/// What the loop's functions work on.
struct SurfaceTraining {
  SurfaceTraining(const SurfaceProvider& the_provider, const SurfaceTrainingOptions& the_options)
      : provider(the_provider), options(the_options), pool(the_provider, the_options.pool, 4) {
    torch::manual_seed(options.loop.seed);
    network = DiffusionNet(options.shape);
    parameters = network->parameters();
  }

  void prepare(std::uint64_t first, int count);
  TrainingShare share(std::uint64_t first, int count);
  Validation validate();

  const SurfaceProvider& provider;
  const SurfaceTrainingOptions& options;
  DiffusionNet network{nullptr};
  std::vector<torch::Tensor> parameters;
  Pool pool;
  std::uint64_t first_of_batch = 0;
  std::vector<SurfaceTensors> batch;  ///< samples from `first_of_batch` on
  std::vector<SurfaceTensors> held_out;
  SurfaceFigures best{.intersection = -1};  ///< of the validations so far
};

void SurfaceTraining::prepare(std::uint64_t first, int count) {
  first_of_batch = first;
  batch.clear();
  for (std::uint64_t i = 0; i < static_cast<std::uint64_t>(count); ++i) batch.push_back(pool[first + i]);
}

TrainingShare SurfaceTraining::share(std::uint64_t first, int count) {
  TrainingShare share;
  for (std::uint64_t sample = first; sample < first + static_cast<std::uint64_t>(count); ++sample) {
    const SurfaceTensors surface = turned(batch[sample - first_of_batch], options, sample);
    const torch::Tensor loss = loss_of(network->forward(surface), surface);
    add_gradients(torch::autograd::grad({loss}, parameters), share.gradients);
    share.loss += loss.item<double>();
  }
  divide_gradients(share.gradients, count);
  share.loss /= count;
  return share;
}

Validation SurfaceTraining::validate() {
  if (held_out.empty())
    for (int i = 0; i < options.loop.validation_samples; ++i)
      held_out.push_back(to_tensors(provider(first_validation_sample + static_cast<std::uint64_t>(i)), true));
  Counts counts;
  for (const SurfaceTensors& surface : held_out) counts.add(network->forward(surface), surface);
  const SurfaceFigures figures = counts.figures();
  if (figures.intersection > best.intersection) best = figures;
  Validation validation;
  validation.selection = figures.intersection;
  validation.figures = {
      {"loss", figures.loss}, {"accuracy", figures.accuracy}, {"intersection_over_union", figures.intersection}};
  validation.notes = {{"validation.samples", std::to_string(options.loop.validation_samples)},
                      {"validation.accuracy", std::to_string(figures.accuracy)},
                      {"validation.intersection_over_union", std::to_string(figures.intersection)}};
  return validation;
}

}  // namespace

SurfaceTrainingResult train_surface(const SurfaceProvider& provider, const SurfaceTrainingOptions& options) {
  require_in_range(options);
  const TensorThreads one_thread(1);
  SurfaceTraining training(provider, options);
  TrainingTask task = task_of(training, options.pool);
  note_surface_shape(options.shape, task.identity);
  note_surface_counts(options.shape, task.notes);
  const TrainingLoopResult result = run_training_loop(*training.network, task, options.loop);
  SurfaceTrainingResult all{result.steps, result.samples, result.last_loss, training.best};
  // The best may be of an earlier run, whose checkpoint says no more of it.
  if (result.best > training.best.intersection) all.best = {.intersection = result.best};
  return all;
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
  TensorFile file = weights_of_run(folder, TensorType::float32, notes);
  read_surface_shape(file.metadata);  // weights of another network must not get out
  return file;
}

}  // namespace rhizodont
