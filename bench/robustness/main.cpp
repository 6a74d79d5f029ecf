// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// How the error of predicted roots depends on what is wrong with a crown: generated teeth that no weights were trained
// on, each with one thing made worse by steps while all else stays as it is.
// usage: bench_robustness DATA_FOLDER MODELS_FOLDER [CSV] [TEETH_PER_TYPE=2] [FACTOR]

#include "evaluation/root_figures.hpp"
#include "evaluation/template_predictor.hpp"
#include "families/scanner_mesh.hpp"
#include "rhizodont/complete.hpp"
#include "rhizodont/error.hpp"
#include "teeth/fdi.hpp"
#include "training/completion_sample.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <functional>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

namespace {

using namespace rhizodont;

/// What may be wrong with a scan.
struct Scan {
  ToothVariation variation;
  GumLine line;
  double shown_share = 0;  // of the tooth's length, above a cut across its long axis; 0: down to the gum line
  double noise_mm = 0.005;
};

struct Factor {
  std::string name, unit;
  std::vector<double> steps;
  std::function<void(Scan&, double)> set;
};

/// A scan as they are when nothing is wrong: cut a little above the junction, along its own curve.
Scan plain_scan() {
  Scan scan;
  scan.line.junction_share = 0.8;
  scan.line.offset_mm = 0.4;
  scan.variation.wear_share = 0;
  return scan;
}

std::vector<Factor> factors() {
  return {{"alpha",
           "share of the tooth's length that is seen",
           {0.5, 0.4, 0.333, 0.25, 0.2, 0.167, 0.125},
           [](Scan& scan, double value) { scan.shown_share = value; }},
          {"tilt",
           "degrees of the cut",
           {0, 4, 8, 12, 16, 20},
           [](Scan& scan, double value) { scan.line.slope.y() = std::tan(value * std::numbers::pi / 180); }},
          {"noise",
           "mm along the normals",
           {0, 0.02, 0.04, 0.07, 0.1},
           [](Scan& scan, double value) { scan.noise_mm = value; }},
          {"gaps",
           "mm of surface that is missing at both contacts",
           {0, 1, 2, 3, 4},
           [](Scan& scan, double value) {
             scan.line.gap_mm = {value, value};
           }},
          {"wear", "mm, largest loss of height", {0, 1, 2, 3, 4}, [](Scan& scan, double value) {
             scan.variation.wear_share = value > 0 ? 1 : 0;
             scan.variation.wear_mm = value;
           }}};
}

std::optional<TriangleMesh> scanned(const SyntheticTooth& tooth, Scan scan, std::uint64_t seed) {
  if (scan.shown_share > 0) {
    scan.line = GumLine{};
    scan.line.junction_share = 0;
    scan.line.offset_mm = tooth.crown_height - scan.shown_share * (tooth.crown_height + tooth.root_length);
    scan.line.slope = slope_across_long_axis(tooth);
  }
  const auto crown = crop_crown(tooth, scan.line);
  if (!crown) return std::nullopt;  // cut among cusps, or below the furcation
  return scanner_mesh(*crown, 0.3, scan.noise_mm, seed);
}

struct Sums {
  int teeth = 0;
  double length = 0, apex = 0, root = 0, chamfer = 0, f_score = 0;

  void add(const RootFigures& f) {
    ++teeth;
    length += std::abs(f.root_length_error_mm);
    apex += f.matched_apex_distance_mm;
    root += f.root_chamfer_mm;
    chamfer += f.chamfer_l2_e3;
    f_score += f.f_score;
  }
};

struct Step {
  double value = 0;
  Sums ours, simple;
  int impossible = 0, refused = 0;  // not to be cut so; no tooth came out
};

class Trial {
 public:
  Trial(const std::filesystem::path& data, const std::filesystem::path& models, std::uint64_t teeth_per_type)
      : families_(load_tooth_families(data, fine())),
        models_(CompletionModels::load(models)),
        teeth_per_type_(teeth_per_type) {
    for (int type = 0; type < tooth_type_count; ++type)
      templates_.push_back(load_template_tooth(data / "templates", fdi_of_type(type, false)));
  }

  Step take(const Factor& factor, double value) const {
    Scan scan = plain_scan();
    factor.set(scan, value);
    Step step;
    step.value = value;
    for (int type = 0; type < tooth_type_count; ++type)
      for (std::uint64_t i = 0; i < teeth_per_type_; ++i) {
        const std::uint64_t seed = first_validation_sample + 7000000 + i;
        const SyntheticTooth tooth = generate_tooth(families_, type, seed, scan.variation);
        try {
          if (const auto crown = scanned(tooth, scan, seed))
            compare(*crown, tooth, step);
          else
            ++step.impossible;
        } catch (const Error&) {
          ++step.refused;
        }
      }
    return step;
  }

 private:
  static FamilyLoadOptions fine() {
    FamilyLoadOptions options;
    options.vertices = 12000;
    return options;
  }

  void compare(const TriangleMesh& crown, const SyntheticTooth& tooth, Step& step) const {
    CompleteOptions options;
    options.fdi = fdi_of_type(tooth.type, false);
    const Eigen::Vector3d axis = crown_growth_axis(crown);
    const TriangleMesh ours = complete_tooth(crown, models_, options).mesh;
    const TriangleMesh simple = fit_template(crown, templates_[static_cast<std::size_t>(tooth.type)]);
    step.ours.add(root_figures(crown, tooth.mesh, ours, axis));
    step.simple.add(root_figures(crown, tooth.mesh, simple, axis));
  }

  ToothFamilies families_;
  CompletionModels models_;
  std::vector<TemplateTooth> templates_;  // by type
  std::uint64_t teeth_per_type_;
};

void print(const Factor& factor, const std::vector<Step>& steps) {
  fmt::print(
      "\n## {}\n\n{}. In brackets: the template fit on the same teeth.\n\n| {} | teeth | root length, mm | apex, mm | "
      "root Chamfer, mm | Chamfer L2 x 1000 | F at 1 % | cannot be cut so | refused "
      "|\n|---|---|---|---|---|---|---|---|"
      "---|\n",
      factor.name, factor.unit, factor.name);
  for (const Step& s : steps) {
    const double n = std::max(1, s.ours.teeth), m = std::max(1, s.simple.teeth);
    fmt::print(
        "| {} | {} | {:.2f} ({:.2f}) | {:.2f} ({:.2f}) | {:.3f} ({:.3f}) | {:.2f} ({:.2f}) | {:.3f} ({:.3f}) | {} "
        "| {} |\n",
        s.value, s.ours.teeth, s.ours.length / n, s.simple.length / m, s.ours.apex / n, s.simple.apex / m,
        s.ours.root / n, s.simple.root / m, s.ours.chamfer / n, s.simple.chamfer / m, s.ours.f_score / n,
        s.simple.f_score / m, s.impossible, s.refused);
  }
  std::fflush(stdout);
}

void write(std::FILE* file, const Factor& factor, const std::vector<Step>& steps) {
  for (const Step& s : steps)
    for (const auto& [who, sums] : {std::pair{"rhizodont", s.ours}, std::pair{"template", s.simple}}) {
      const double n = std::max(1, sums.teeth);
      fmt::print(file, "{},{},{},{},{:.4f},{:.4f},{:.4f}\n", factor.name, s.value, who, sums.teeth, sums.length / n,
                 sums.root / n, sums.f_score / n);
    }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    fmt::print(stderr, "usage: bench_robustness DATA_FOLDER MODELS_FOLDER [CSV] [TEETH_PER_TYPE=2] [FACTOR]\n");
    return 2;
  }
  try {
    const Trial trial(argv[1], argv[2], argc > 4 ? std::strtoull(argv[4], nullptr, 10) : 2);
    std::FILE* csv = argc > 3 ? std::fopen(argv[3], "w") : nullptr;
    if (argc > 3 && csv == nullptr) throw InputError(std::string(argv[3]) + " cannot be written.");
    if (csv != nullptr) fmt::print(csv, "factor,value,predictor,teeth,root_length_mm,root_chamfer_mm,f_score\n");
    for (const Factor& factor : factors()) {
      if (argc > 5 && factor.name != argv[5]) continue;
      std::vector<Step> steps;
      for (const double value : factor.steps) steps.push_back(trial.take(factor, value));
      print(factor, steps);
      if (csv != nullptr) write(csv, factor, steps);
    }
    if (csv != nullptr) std::fclose(csv);
    return 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
