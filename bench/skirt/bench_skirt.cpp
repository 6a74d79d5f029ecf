// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Finding the skirt: time by the crown's size, and whether a decimated copy does as well as the crown itself.
//   bench_skirt DATA WEIGHTS
#include "common/bench_teeth.hpp"
#include "common/timing.hpp"
#include "mesh/adjacency.hpp"
#include "rhizodont/error.hpp"
#include "skirt/skirt.hpp"
#include "skirt/skirt_border.hpp"
#include "skirt/skirt_network.hpp"
#include "skirt/spikes.hpp"
#include "training/skirt_sample.hpp"

#include <fmt/core.h>

#include <cstdio>
#include <exception>
#include <filesystem>
#include <vector>

namespace {

using namespace rhizodont;

void print_times(const TriangleMesh& crown, const SurfaceNetwork& network, std::vector<double>& sizes,
                 std::vector<double>& seconds) {
  std::vector<float> confidence;
  const int repeats = crown.vertices.size() > 20000 ? 1 : 3;
  const double judging = median_seconds([&] { confidence = skirt_confidence(crown, network); }, repeats);
  std::vector<bool> keep;
  const double border = median_seconds([&] { keep = tooth_triangles(crown, confidence); }, repeats);
  const auto take_off = [&] {
    const KeptCrown rest = keep_crown(crown, keep, DropReason::skirt);
    keep_crown(rest.mesh, triangles_without_spikes(rest.mesh), DropReason::spike);
  };
  const double taking = median_seconds(take_off, repeats);
  fmt::print("| {} | {:.3f} | {:.3f} | {:.3f} | {:.3f} |\n", crown.vertices.size(), judging, border, taking,
             judging + border + taking);
  std::fflush(stdout);
  sizes.push_back(static_cast<double>(crown.vertices.size()));
  seconds.push_back(judging + border + taking);
}

struct Agreement {
  double right = 0, vertices = 0, both = 0, either = 0;
  void add(bool said_skirt, bool is_skirt) {
    right += said_skirt == is_skirt;
    ++vertices;
    both += said_skirt && is_skirt;
    either += said_skirt || is_skirt;
  }
  void print(const char* name) const {
    fmt::print("| {} | {:.4f} | {:.4f} |\n", name, right / vertices, either > 0 ? both / either : 1);
  }
};

/// Raw crowns as fine as scanners give them, judged whole and on a decimated copy, before and after the border is
/// drawn.
void print_agreement(const ToothFamilies& families, const SurfaceNetwork& network, int crowns) {
  SkirtSampleOptions options;
  options.finest_edge_mm = 0.16;
  options.coarsest_edge_mm = 0.19;
  Agreement whole, copy, cleaned;
  double vertices = 0;
  for (int i = 0; i < crowns; ++i) {
    const SkirtSample sample =
        make_skirt_sample(families, (std::uint64_t{1} << 41) + static_cast<std::uint64_t>(i), options);
    SkirtNetworkOptions all;
    all.most_vertices = 1'000'000;
    const auto on_whole = skirt_confidence(sample.mesh, network, all), on_copy = skirt_confidence(sample.mesh, network);
    std::vector<bool> kept(sample.mesh.vertices.size(), false);
    try {
      const KeptCrown crown = keep_crown(sample.mesh, tooth_triangles(sample.mesh, on_copy), DropReason::skirt);
      for (const int v : crown.old_vertices) kept[static_cast<std::size_t>(v)] = true;
    } catch (const InputError&) {
    }
    for (std::size_t v = 0; v < kept.size(); ++v) {
      const bool skirt = sample.is_tooth[v] == 0;
      whole.add(on_whole[v] < 0.5F, skirt);
      copy.add(on_copy[v] < 0.5F, skirt);
      cleaned.add(!kept[v], skirt);
    }
    vertices += static_cast<double>(kept.size()) / crowns;
  }
  fmt::print("\n{} generated raw crowns, {:.0f} vertices on average:\n\n", crowns, vertices);
  fmt::print("| judged on | accuracy | intersection over union of the skirt |\n|---|---|---|\n");
  whole.print("the crown itself");
  copy.print("a copy of 3,500 vertices");
  cleaned.print("that copy, border drawn");
}

void run(const std::filesystem::path& data, const std::filesystem::path& weights) {
  const SurfaceNetwork network = SurfaceNetwork::load(weights);
  fmt::print("| vertices | judging, s | border, s | taking off, s | in all, s |\n|---|---|---|---|---|\n");
  std::vector<double> sizes, seconds;
  for (const BenchTooth& tooth : load_validation_teeth(data)) {
    if (tooth.fdi != 36 && tooth.fdi != 35) continue;
    TriangleMesh crown = refined(tooth.crown);
    for (int i = 0; i < (tooth.fdi == 36 ? 3 : 2); ++i, crown = refined(crown))
      print_times(crown, network, sizes, seconds);
  }
  print_agreement(load_tooth_families(data), network, 24);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    fmt::print(stderr, "usage: bench_skirt DATA WEIGHTS\n");
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
