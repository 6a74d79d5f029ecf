// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Time of the finished networks beside the trainers' own forward pass in float on the same crowns, in one run:
// bench_networks DATA MODELS. Compared on one thread each: where other work shares the processor, OpenMP's threads spin
// at every barrier of torch, and more of them would time the waiting.
#include "common/bench_teeth.hpp"
#include "common/timing.hpp"
#include "completion/mean_crowns.hpp"
#include "completion/registration.hpp"
#include "learning/adapointr.hpp"
#include "learning/diffusion_net.hpp"
#include "learning/threads.hpp"
#include "learning/with_weights.hpp"
#include "mesh/sampling.hpp"
#include "networks/completion_network.hpp"
#include "networks/surface_network.hpp"
#include "skirt/skirt_features.hpp"
#include "skirt/skirt_network.hpp"
#include "teeth/prepared_crown.hpp"

#include <fmt/core.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <exception>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace {

using namespace rhizodont;

struct Milliseconds {
  double clock = 0, processor = 0;
};

/// Of `work`, over `repeats` runs: the median by the clock, the mean of the processor; per item of `items`.
Milliseconds measured(const std::function<void()>& work, int items, int repeats = 9) {
  work();
  const std::clock_t before = std::clock();
  const double seconds = median_seconds(work, repeats);
  const double processor = static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC / (repeats + 1);
  return {1000 * seconds / items, 1000 * processor / items};
}

/// Ours on one thread and on all, torch's on one.
void print_row(const std::string& what, int items, const std::function<void()>& ours,
               const std::function<void()>& theirs) {
  const Milliseconds all = measured(ours, items);
  const tbb::global_control control(tbb::global_control::max_allowed_parallelism, 1);
  const TensorThreads one_thread(1);
  const Milliseconds one = measured(ours, items), torch = measured(theirs, items);
  fmt::print("| {} | {:.1f} | {:.1f} | {:.2f} | {:.1f} | {:.1f} |\n", what, one.processor, torch.processor,
             torch.processor / one.processor, all.clock, all.processor);
  std::fflush(stdout);
}

std::vector<CrownPoints> network_inputs(const std::vector<BenchTooth>& teeth, const Atlas& atlas, int count) {
  std::vector<CrownPoints> inputs;
  for (const BenchTooth& tooth : teeth) {
    const int type = tooth_type_of_fdi(tooth.fdi);
    const CrownFrame frame =
        canonical_frame(prepare_crown(tooth.crown), tooth.fdi, atlas.types[static_cast<std::size_t>(type)]);
    inputs.push_back({{}, type, frame.form_axis.cast<float>()});
    for (const Point& p : sample_surface(tooth.crown, static_cast<std::size_t>(count), 1).points)
      inputs.back().points.push_back(frame.frame.to_canonical(p).cast<float>());
  }
  return inputs;
}

void time_completion(const std::vector<BenchTooth>& teeth, const std::filesystem::path& models) {
  const TensorFile file = read_safetensors(models / "completion.safetensors");
  const CompletionShape shape = read_shape(file.metadata);
  AdaPoinTr trainers = with_weights(AdaPoinTr(shape), file);
  const CompletionNetwork ours = CompletionNetwork::load(models / "completion.safetensors");
  const auto inputs = network_inputs(teeth, load_atlas(models / "atlas.safetensors"), shape.input_points);
  for (const std::size_t batch : {std::size_t{1}, inputs.size()}) {
    const std::span<const CrownPoints> crowns = std::span(inputs).first(batch);
    std::vector<std::vector<float>> points(batch);
    std::vector<std::int64_t> types;
    std::vector<float> axes;
    for (std::size_t i = 0; i < batch; ++i) {
      for (const auto& p : crowns[i].points) points[i].insert(points[i].end(), p.data(), p.data() + 3);
      types.push_back(crowns[i].type);
      axes.insert(axes.end(), crowns[i].form_axis.data(), crowns[i].form_axis.data() + 2);
    }
    const auto forward = [&] {
      torch::NoGradGuard no_gradient;
      trainers->forward(make_crown_batch(shape, points, types, axes), {}, {}, layers::Precision::single);
    };
    const int items = static_cast<int>(batch);
    print_row(
        fmt::format("completion, crowns at once: {}", batch), items, [&] { ours.complete(crowns); }, forward);
  }
}

void time_skirt(const TriangleMesh& crown, const std::filesystem::path& models) {
  const TensorFile file = read_safetensors(models / "skirt.safetensors");
  const SurfaceShape shape = read_surface_shape(file.metadata);
  DiffusionNet trainers = with_weights(DiffusionNet(shape), file);
  const SurfaceNetwork ours = SurfaceNetwork::load(models / "skirt.safetensors");
  const SurfaceSample surface = skirt_features(crown, shape.eigenvectors);
  const auto forward = [&] {
    torch::NoGradGuard no_gradient;
    trainers->forward(to_tensors(surface, false));
  };
  print_row(
      fmt::format("skirt, {} vertices", surface.vertices), 1, [&] { ours.confidence(surface); }, forward);
}

void run(const std::filesystem::path& data, const std::filesystem::path& models) {
  fmt::print("Milliseconds per crown.\n\n");
  fmt::print("| | one thread, processor | torch, one thread, processor | torch / ours | all threads, clock | ");
  fmt::print("all threads, processor |\n|---|---|---|---|---|---|\n");
  const std::vector<BenchTooth> teeth = load_validation_teeth(data);
  time_completion(teeth, models);
  constexpr std::size_t vertices = 5000;
  TriangleMesh crown = teeth.front().crown;
  while (crown.vertices.size() < vertices) crown = refined(crown);
  time_skirt(decimated(crown, vertices), models);
  for (const char* name : {"completion.safetensors", "skirt.safetensors"}) {
    const double seconds = median_seconds([&] {
      if (std::string(name).starts_with("c"))
        CompletionNetwork::load(models / name);
      else
        SurfaceNetwork::load(models / name);
    });
    fmt::print("\n{} is loaded in {:.1f} ms.\n", name, 1000 * seconds);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    fmt::print(stderr, "usage: bench_networks DATA MODELS\n");
    return 2;
  }
  try {
    run(argv[1], argv[2]);
    return 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
