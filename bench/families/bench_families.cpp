// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// How fast teeth and training samples are made, whether they are sound, and how near the families come to real crowns.
#include "base/parallel_tasks.hpp"
#include "base/stopwatch.hpp"
#include "common/timing.hpp"
#include "crown_fit.hpp"
#include "families/mean_teeth.hpp"
#include "mesh/diagnosis.hpp"
#include "mesh/self_intersection.hpp"
#include "registration_error.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/io.hpp"
#include "root_curves.hpp"
#include "teeth/fdi.hpp"
#include "training/completion_sample.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string>

namespace rhizodont {
namespace {

void speed(const ToothFamilies& families, double load_seconds) {
  constexpr int batch = 64;
  const double samples = median_seconds(
      [&] {
        for (std::uint64_t i = 0; i < batch; ++i) make_completion_sample(families, 1000 + i);
      },
      3);
  const double teeth = median_seconds(
      [&] {
        for (int i = 0; i < batch; ++i) generate_tooth(families, i % tooth_type_count, static_cast<std::uint64_t>(i));
      },
      3);
  fmt::print("| what | one thread |\n|---|---|\n| loading all families | {:.1f} s |\n", load_seconds);
  fmt::print("| whole teeth | {:.0f} /s |\n| training samples, crop and points included | {:.0f} /s |\n\n",
             batch / teeth, batch / samples);
}

void soundness(const ToothFamilies& families, std::uint64_t seeds) {
  struct Row {
    std::size_t open = 0, crossing = 0, late = 0;
    std::array<std::size_t, 4> roots{};
    double length = 0, squares = 0, shortest = 1e9, longest = 0;
  };
  std::array<Row, tooth_type_count> rows{};
  parallel_tasks(tooth_type_count, [&](int type) {
    Row& row = rows[static_cast<std::size_t>(type)];
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
      const SyntheticTooth tooth = generate_tooth(families, type, (std::uint64_t{1} << 33) + seed);
      if (!diagnose(tooth.mesh).is_closed_solid()) ++row.open;
      if (!self_intersecting_triangles(tooth.mesh).empty()) ++row.crossing;
      if (tooth.apices.size() > 1 && -tooth.furcation_z > 0.6 * tooth.root_length) ++row.late;
      ++row.roots[std::min<std::size_t>(3, tooth.apices.size())];
      row.length += tooth.root_length / static_cast<double>(seeds);
      row.squares += tooth.root_length * tooth.root_length / static_cast<double>(seeds);
      row.shortest = std::min(row.shortest, tooth.root_length);
      row.longest = std::max(row.longest, tooth.root_length);
    }
  });
  fmt::print(
      "| tooth | teeth | not closed, genus 0 | with crossing triangles | 1 / 2 / 3 roots | parted late | root length "
      "mm: mean | "
      "deviation | least | most |\n|---|---|---|---|---|---|---|---|---|---|\n");
  for (int type = 0; type < tooth_type_count; ++type) {
    const Row& row = rows[static_cast<std::size_t>(type)];
    fmt::print("| {} | {} | {} | {} | {} / {} / {} | {} | {:.1f} | {:.2f} | {:.1f} | {:.1f} |\n",
               fdi_of_type(type, false), seeds, row.open, row.crossing, row.roots[1], row.roots[2], row.roots[3],
               row.late, row.length, std::sqrt(std::max(0.0, row.squares - row.length * row.length)), row.shortest,
               row.longest);
  }
  fmt::print("\n");
}

void nearness(const ToothFamilies& families, const std::filesystem::path& data) {
  FamilyLoadOptions plain;
  plain.crown_modes = 0;
  const ToothFamilies templates = load_tooth_families(data, plain);
  const Atlas atlas = make_atlas(families);
  std::vector<std::pair<int, int>> crowns;
  for (int patient = 0; patient < 2; ++patient)
    for (int quadrant = 1; quadrant <= 4; ++quadrant)
      for (int place = 1; place <= 7; ++place) crowns.emplace_back(patient, 10 * quadrant + place);
  std::vector<std::array<double, 4>> distance(crowns.size());
  parallel_tasks(crowns.size(), [&](std::size_t i) {
    const auto [patient, fdi] = crowns[i];
    const TriangleMesh crown =
        load_mesh(data / "crowns" / ("patient" + std::to_string(patient)) / ("crown_" + std::to_string(fdi) + ".ply"))
            .mesh;
    const int type = tooth_type_of_fdi(fdi);
    const CrownPoints posed = pose_crown(families, atlas, crown, fdi);
    distance[i] = {fit_crown(templates, type, posed, {false, false}), fit_crown(templates, type, posed, {true, false}),
                   fit_crown(families, type, posed, {true, false}), fit_crown(families, type, posed, {true, true})};
  });
  fmt::print(
      "| tooth | template, one scale, mm | template, three scales | mean form, three scales | with modes |\n"
      "|---|---|---|---|---|\n");
  std::array<double, 4> all{};
  for (int type = 0; type < tooth_type_count; ++type) {
    std::array<double, 4> sum{};
    double count = 0;
    for (std::size_t i = 0; i < crowns.size(); ++i) {
      if (tooth_type_of_fdi(crowns[i].second) != type) continue;
      for (std::size_t k = 0; k < 4; ++k) sum[k] += distance[i][k], all[k] += distance[i][k];
      count += 1;
    }
    if (count > 0)
      fmt::print("| {} | {:.3f} | {:.3f} | {:.3f} | {:.3f} |\n", fdi_of_type(type, false), sum[0] / count,
                 sum[1] / count, sum[2] / count, sum[3] / count);
  }
  const double count = static_cast<double>(crowns.size());
  fmt::print("| all {} | {:.3f} | {:.3f} | {:.3f} | {:.3f} |\n", crowns.size(), all[0] / count, all[1] / count,
             all[2] / count, all[3] / count);
}

int run(const std::filesystem::path& data, std::uint64_t seeds) {
  const Stopwatch watch;
  const ToothFamilies families = load_tooth_families(data);
  speed(families, watch.seconds());
  soundness(families, seeds);
  curve_table(families, seeds);
  registration_table(families, std::max<std::uint64_t>(seeds, 2));
  nearness(families, data);
  return 0;
}

}  // namespace
}  // namespace rhizodont

int main(int argc, char** argv) {
  if (argc < 2) {
    fmt::print(stderr, "usage: bench_families DATA_FOLDER [TEETH_PER_TYPE]\n");
    return 2;
  }
  try {
    return rhizodont::run(argv[1], argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 20);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
