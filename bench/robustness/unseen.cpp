// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// What a crown cannot tell: how far a predictor is off that knows all of a generated tooth but one thing, and takes the
// family's mean for that. No predictor can do better on such teeth as far as the crown does not show this thing. The
// waves of the surface run on into the crown and are left as they are.
//
// usage: bench_unseen DATA_FOLDER [TEETH_PER_TYPE=10]

#include "evaluation/root_figures.hpp"
#include "families/tooth_family.hpp"
#include "teeth/fdi.hpp"
#include "training/completion_sample.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <functional>
#include <string>
#include <vector>

namespace {

using namespace rhizodont;

struct Unknown {
  std::string name;
  std::function<void(ToothVariation&)> forget;
};

std::vector<Unknown> unknowns() {
  const auto lean = [](ToothVariation& v) { v.lean = 0; };
  const auto length = [](ToothVariation& v) { v.root_length = 0; };
  const auto bend = [](ToothVariation& v) { v.distal_bend_mm = v.curvature = 0; };
  const auto shape = [](ToothVariation& v) { v.root_thickness = v.taper = 0; };
  const auto roots = [](ToothVariation& v) { v.divergence_mm = v.trunk = 0; };
  return {{"nothing (spacing of the samples)", [](ToothVariation&) {}},
          {"the root's lean", lean},
          {"its length", length},
          {"its bend", bend},
          {"thickness and taper", shape},
          {"trunk and divergence", roots},
          {"lean and length", [=](ToothVariation& v) { lean(v), length(v); }},
          {"lean, length and bend", [=](ToothVariation& v) { lean(v), length(v), bend(v); }},
          {"all of these", [=](ToothVariation& v) { lean(v), length(v), bend(v), shape(v), roots(v); }}};
}

/// Whether two teeth grew from the same draw: a draw that is rejected for one of them gives another crown.
bool same_crown(const SyntheticTooth& a, const SyntheticTooth& b) {
  if (a.mesh.vertices.size() != b.mesh.vertices.size()) return false;
  double sum = 0, count = 0;
  for (std::size_t v = 0; v < a.mesh.vertices.size(); ++v) {
    if (a.crown[v] == 0 || a.mesh.vertices[v].z() < 2) continue;
    sum += (a.mesh.vertices[v] - b.mesh.vertices[v]).norm();
    ++count;
  }
  return sum < 0.3 * count;
}

void row(const ToothFamilies& families, const Unknown& unknown, std::uint64_t teeth_per_type) {
  GumLine line;
  line.junction_share = 0.8;
  line.offset_mm = 0.4;
  double teeth = 0, length = 0, apex = 0, root = 0, angle = 0, chamfer = 0, f_score = 0;
  for (int type = 0; type < tooth_type_count; ++type)
    for (std::uint64_t i = 0; i < teeth_per_type; ++i) {
      const std::uint64_t seed = first_validation_sample + 8000000 + i;
      const SyntheticTooth truth = generate_tooth(families, type, seed);
      ToothVariation variation;
      unknown.forget(variation);
      const SyntheticTooth guess = generate_tooth(families, type, seed, variation);
      const auto crown = crop_crown(truth, line);
      if (!crown || !same_crown(truth, guess)) continue;
      const RootFigures f = root_figures(*crown, truth.mesh, guess.mesh, truth.growth_axis);
      ++teeth;
      length += std::abs(f.root_length_error_mm);
      apex += f.matched_apex_distance_mm;
      root += f.root_chamfer_mm;
      angle += f.root_axis_angle_deg;
      chamfer += f.chamfer_l2_e3;
      f_score += f.f_score;
    }
  fmt::print("| {} | {} | {:.2f} | {:.2f} | {:.3f} | {:.1f} | {:.2f} | {:.3f} |\n", unknown.name, teeth, length / teeth,
             apex / teeth, root / teeth, angle / teeth, chamfer / teeth, f_score / teeth);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    fmt::print(stderr, "usage: bench_unseen DATA_FOLDER [TEETH_PER_TYPE=10]\n");
    return 2;
  }
  try {
    const ToothFamilies families = load_tooth_families(argv[1]);
    fmt::print(
        "| not known | teeth | root length, mm | apex, mm | root Chamfer, mm | axis, degrees | Chamfer L2 x 1000 "
        "| F at 1 % |\n|---|---|---|---|---|---|---|---|\n");
    for (const Unknown& unknown : unknowns())
      row(families, unknown, argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 10);
    return 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
