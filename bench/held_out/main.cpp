// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// How right roots of generated people are who were never trained on, nor calibrated on, by tooth type.
// usage: bench_held_out DATA_FOLDER MODELS_FOLDER [PEOPLE=60] [COMPLETED=6] [TILTED=3] [POSED=0]
// Of the first COMPLETED people one tooth of each type is made as a mesh, beside the template fit: distances of the
// surfaces, numbers of roots, intervals as a user gets them. Of all PEOPLE the same teeth are predicted as points:
// lengths, apices, intervals, shreds. Of the first TILTED the crowns are cut along the junction and along planes that
// lean against it. Of the first POSED it is told how far off their crowns are laid, and what that costs.
#include "base/parallel_tasks.hpp"
#include "completion/uncertainty.hpp"
#include "evaluation/evaluate_cases.hpp"
#include "evaluation/held_out_people.hpp"
#include "evaluation/predictors.hpp"
#include "families/crown_crop.hpp"
#include "pipeline/models.hpp"
#include "poses.hpp"
#include "rhizodont/complete.hpp"
#include "rhizodont/error.hpp"
#include "teeth/fdi.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace rhizodont;

struct Trial {
  ToothFamilies families;
  CompletionModels models;
  std::filesystem::path templates;
};

/// The program and the template fit. The teeth go side by side, so one thread for each.
std::vector<NamedPredictor> predictors_of(const Trial& trial) {
  CompleteOptions options;
  options.threads = 1;
  return {completing_predictor(trial.models, options), template_predictor(trial.templates)};
}

std::string name_of(int fdi) { return fmt::format("{}", fdi); }

/// Calls `make(person, type)` for one tooth of each type of so many people, side by side.
template <class Result, class Make>
std::vector<Result> of_people(std::size_t people, const Make& make) {
  std::vector<Result> results(people * tooth_type_count);
  parallel_tasks(results.size(), [&](std::size_t i) {
    try {
      results[i] = make(held_out_person(HeldOutPeople::for_figures, i / tooth_type_count),
                        static_cast<int>(i % tooth_type_count));
    } catch (const UsageError&) {
      throw;
    } catch (const Error&) {
      // no crown came off, or no root could be predicted: counted by what is missing
    }
  });
  return results;
}

using ByTooth = std::map<int, double>;  // by the FDI number of a type's left tooth

/// A tooth as both predictors complete it.
struct Completed {
  std::optional<EvaluatedCase> evaluated;
  std::optional<double> longer;  // mm, than the points
};

Evaluation with_predictors(const std::vector<NamedPredictor>& predictors) {
  Evaluation evaluation;
  for (const NamedPredictor& predictor : predictors) evaluation.predictors.push_back(predictor.name);
  return evaluation;
}

void print_means(const std::string& name, const Evaluation& part, const std::vector<double>& longer) {
  const MeanFigures ours = mean_figures(part, 0, MeanOver::completed_by_all),
                    theirs = mean_figures(part, 1, MeanOver::completed_by_all);
  const Coverage held = coverage(part, 0);
  int refused = 0;
  for (const EvaluatedCase& evaluated : part.cases) refused += evaluated.outcomes[0].figures ? 0 : 1;
  fmt::print(
      "| {} | {} | {:+.2f} | {:.2f} ({:.2f}) | {:.2f} ({:.2f}) | {:.3f} ({:.3f}) | {:.2f} | {:.2f} ({:.2f}) | {:.2f} | "
      "{:.3f} ({:.3f}) | {} | {:.0f} % | {:.0f} % | {} | {} |\n",
      name, ours.teeth, ours.root_length_bias_mm, ours.root_length_abs_error_mm, theirs.root_length_abs_error_mm,
      ours.matched_apex_distance_mm, theirs.matched_apex_distance_mm, ours.root_chamfer_mm, theirs.root_chamfer_mm,
      ours.root_chamfer_mm / std::max(1e-9, theirs.root_chamfer_mm), ours.chamfer_l2_e3, theirs.chamfer_l2_e3,
      ours.chamfer_l2_e3 / std::max(1e-9, theirs.chamfer_l2_e3), ours.f_score, theirs.f_score, ours.right_root_counts,
      100 * held.length, 100 * held.apex, longer.empty() ? "" : fmt::format("{:+.2f}", median(longer)), refused);
}

/// Returns how much longer surfaces are than their points.
ByTooth print_completed(const Trial& trial, std::size_t people) {
  const std::vector<NamedPredictor> predictors = predictors_of(trial);
  const auto teeth = of_people<Completed>(people, [&](const PersonDraw& person, int type) {
    const SyntheticTooth tooth = held_out_tooth(trial.families, person, type);
    const TriangleMesh crown = scanned_crown(held_out_crown(tooth, person), person);
    const int fdi = fdi_of_type(type, false);
    Completed completed;
    completed.evaluated.emplace();
    completed.evaluated->files.fdi = fdi;
    for (const NamedPredictor& predictor : predictors)
      completed.evaluated->outcomes.push_back(evaluate_case(predictor.predict, fdi, crown, tooth.mesh));
    if (completed.evaluated->outcomes[0].figures)
      completed.longer =
          surface_longer(completed.evaluated->outcomes[0], predicted_root(crown, tooth.mesh, fdi, trial.models));
    return completed;
  });
  fmt::print(
      "## Meshes\n\n{} people; in brackets the template fit on the same teeth, and our share of its error. Surface: "
      "the mesh's root less that of its points, median.\n\n| tooth | teeth | length bias, mm | length, mm | apices, mm "
      "| root "
      "Chamfer, mm | share | Chamfer L2 x 1000 | share | F at 1 % | right roots | lengths held | apices held | "
      "surface, "
      "mm | refused |\n|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n",
      people);
  std::array<Evaluation, tooth_type_count + 2> parts;  // then molars, then all
  std::array<std::vector<double>, tooth_type_count + 2> longer;
  parts.fill(with_predictors(predictors));
  constexpr std::size_t molars = tooth_type_count, all = tooth_type_count + 1;
  for (std::size_t i = 0; i < teeth.size(); ++i) {
    if (!teeth[i].evaluated) continue;
    const std::size_t type = i % tooth_type_count;
    std::vector<std::size_t> to{type, all};
    if (type % 8 >= 5) to.push_back(molars);
    for (const std::size_t part : to) {
      parts[part].cases.push_back(*teeth[i].evaluated);
      if (teeth[i].longer) longer[part].push_back(*teeth[i].longer);
    }
  }
  for (std::size_t part = 0; part < parts.size(); ++part)
    print_means(part == molars ? "molars"
                : part == all  ? "all"
                               : name_of(fdi_of_type(static_cast<int>(part), false)),
                parts[part], longer[part]);
  std::fflush(stdout);
  std::map<int, std::vector<double>> by_type;
  for (int type = 0; type < tooth_type_count; ++type)
    by_type[fdi_of_type(type, false)] = longer[static_cast<std::size_t>(type)];
  return surface_longer_by_type(by_type);
}

/// Sums over the predicted roots of a type, or of all.
struct OfPoints {
  std::vector<RootOutcome> roots;
  double bias = 0, error = 0;
  int shreds = 0, missing = 0;

  void add(const std::optional<PredictedRoot>& root, double surface_longer) {
    if (!root) {
      ++missing;
      return;
    }
    const RootOutcome outcome = lengthened(*root, surface_longer);
    const double off = outcome.length_mm - outcome.true_length_mm;
    bias += off, error += std::abs(off);
    shreds += root->source != RootSource::network ? 1 : 0;
    roots.push_back(outcome);
  }
};

void print_points(const Trial& trial, std::size_t people, const ByTooth& longer) {
  const auto roots = of_people<std::optional<PredictedRoot>>(people, [&](const PersonDraw& person, int type) {
    const SyntheticTooth tooth = held_out_tooth(trial.families, person, type);
    return predicted_root(held_out_crown(tooth, person), tooth.mesh, fdi_of_type(type, false), trial.models);
  });
  std::array<OfPoints, tooth_type_count + 1> sums;  // the last of all
  for (std::size_t i = 0; i < roots.size(); ++i) {
    const std::size_t type = i % tooth_type_count;
    const auto of_type = longer.find(fdi_of_type(static_cast<int>(type), false));  // none: nothing was completed
    for (const std::size_t to : {type, std::size_t{tooth_type_count}})
      sums[to].add(roots[i], of_type == longer.end() ? 0 : of_type->second);
  }
  fmt::print(
      "\n## Points\n\n{} people; lengths with what the surface adds to or takes from its points above. Shreds: the "
      "first prediction fell to pieces. Missing: no crown or no root.\n\n"
      "| tooth | teeth | length bias, mm | length error, mm | lengths held | mean width, mm | apices held | shreds "
      "| missing |\n|---|---|---|---|---|---|---|---|---|\n",
      people);
  const auto& metadata = content_of(trial.models)->network.metadata();
  for (int type = 0; type <= tooth_type_count; ++type) {
    const OfPoints& s = sums[static_cast<std::size_t>(type)];
    const double n = std::max<double>(1, static_cast<double>(s.roots.size()));
    const Coverage held = coverage(s.roots, metadata);
    fmt::print("| {} | {} | {:+.2f} | {:.2f} | {:.1f} % | {:.1f} | {:.1f} % | {} | {} |\n",
               type == tooth_type_count ? "all" : name_of(fdi_of_type(type, false)), s.roots.size(), s.bias / n,
               s.error / n, 100 * held.length, held.interval_width_mm, 100 * held.apex, s.shreds, s.missing);
  }
  std::fflush(stdout);
}

constexpr std::array<double, 3> tilts{0, 20, 30};  // degrees

/// One tooth's crown cut at each tilt, towards a side of its own, and completed; nothing unless all came out.
std::optional<std::array<EvaluatedCase, tilts.size()>> tilted(const Trial& trial,
                                                              const std::vector<NamedPredictor>& predictors,
                                                              const PersonDraw& person, int type) {
  const SyntheticTooth tooth = held_out_tooth(trial.families, person, type);
  RandomStream random(person.seed, 600 + static_cast<std::uint64_t>(type));
  const double side = random.uniform(0, 2 * std::numbers::pi);
  std::array<EvaluatedCase, tilts.size()> result;
  for (std::size_t t = 0; t < tilts.size(); ++t) {
    GumLine line;  // as a scan ends: a little above the junction, along its own curve
    line.junction_share = 0.8;
    line.offset_mm = 0.4;
    line.slope = std::tan(tilts[t] * std::numbers::pi / 180) * Eigen::Vector2d(std::cos(side), std::sin(side));
    const auto crop = crop_crown(tooth, line);
    if (!crop) return std::nullopt;
    const TriangleMesh crown = scanned_crown(*crop, person);
    result[t].files.fdi = fdi_of_type(type, false);
    for (const NamedPredictor& predictor : predictors)
      result[t].outcomes.push_back(evaluate_case(predictor.predict, result[t].files.fdi, crown, tooth.mesh));
    if (!result[t].outcomes[0].figures) return std::nullopt;
  }
  return result;
}

void print_tilts(const Trial& trial, std::size_t people) {
  const std::vector<NamedPredictor> predictors = predictors_of(trial);
  using Teeth = std::optional<std::array<EvaluatedCase, tilts.size()>>;
  const auto teeth = of_people<Teeth>(
      people, [&](const PersonDraw& person, int type) { return tilted(trial, predictors, person, type); });
  fmt::print(
      "\n## Tilt\n\nTeeth of {} people that can be cut and completed at each tilt; in brackets the template fit.\n\n"
      "| degrees | teeth | length, mm | apices, mm | root Chamfer, mm | times level | Chamfer L2 x 1000 | times level "
      "|\n"
      "|---|---|---|---|---|---|---|---|\n",
      people);
  MeanFigures level;
  for (std::size_t t = 0; t < tilts.size(); ++t) {
    Evaluation evaluation = with_predictors(predictors);
    for (const Teeth& tooth : teeth)
      if (tooth) evaluation.cases.push_back((*tooth)[t]);
    const MeanFigures ours = mean_figures(evaluation, 0), theirs = mean_figures(evaluation, 1);
    if (t == 0) level = ours;
    fmt::print(
        "| {} | {} | {:.2f} ({:.2f}) | {:.2f} ({:.2f}) | {:.3f} ({:.3f}) | {:.2f} | {:.2f} ({:.2f}) | {:.2f} |\n",
        tilts[t], ours.teeth, ours.root_length_abs_error_mm, theirs.root_length_abs_error_mm,
        ours.matched_apex_distance_mm, theirs.matched_apex_distance_mm, ours.root_chamfer_mm, theirs.root_chamfer_mm,
        ours.root_chamfer_mm / std::max(1e-9, level.root_chamfer_mm), ours.chamfer_l2_e3, theirs.chamfer_l2_e3,
        ours.chamfer_l2_e3 / std::max(1e-9, level.chamfer_l2_e3));
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    fmt::print(stderr,
               "usage: bench_held_out DATA_FOLDER MODELS_FOLDER [PEOPLE=60] [COMPLETED=6] [TILTED=3] [POSED=0]\n");
    return 2;
  }
  const auto count = [&](int at, std::size_t usual) {
    return argc > at ? static_cast<std::size_t>(std::strtoul(argv[at], nullptr, 10)) : usual;
  };
  try {
    const std::filesystem::path data = argv[1];
    const Trial trial{load_tooth_families(data), CompletionModels::load(argv[2]), data / "templates"};
    ByTooth longer;
    if (count(4, 6) > 0) longer = print_completed(trial, count(4, 6));
    if (count(3, 60) > 0) print_points(trial, count(3, 60), longer);
    if (count(5, 3) > 0) print_tilts(trial, count(5, 3));
    if (count(6, 0) > 0) print_poses(trial.families, trial.models, count(6, 0));
    return 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
