// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluation/evaluate_cases.hpp"

#include "base/lower_case.hpp"
#include "base/stopwatch.hpp"
#include "mesh/closest_point.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/io.hpp"
#include "teeth/fdi.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string_view>
#include <system_error>

namespace rhizodont {
namespace {

bool is_mesh_file(const std::filesystem::path& file) {
  constexpr std::array<std::string_view, 5> extensions{".ply", ".stl", ".obj", ".off", ".vtp"};
  const std::string extension = lower_case(file.extension().string());
  return std::find(extensions.begin(), extensions.end(), extension) != extensions.end();
}

/// The permanent tooth of "36" or "36_anything".
std::optional<int> tooth_of(std::string_view number) {
  const auto fdi = read_fdi(number.substr(0, 2));
  const bool alone = number.size() <= 2 || number[2] == '_';
  return fdi && is_permanent_tooth(*fdi) && alone ? fdi : std::nullopt;
}

/// Mesh files prefix_NUMBER.extension of a folder by NUMBER.
std::map<std::string, std::filesystem::path> numbered_files(const std::filesystem::path& folder,
                                                            std::string_view prefix) {
  std::map<std::string, std::filesystem::path> files;
  std::error_code error;
  for (std::filesystem::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    const std::string stem = at->path().stem().string();
    if (!stem.starts_with(prefix) || !is_mesh_file(at->path())) continue;
    const auto [place, fresh] = files.try_emplace(stem.substr(prefix.size()), at->path());
    if (!fresh) throw InputError("The folder " + folder.string() + " has more than one file " + stem + ".");
  }
  if (error) throw InputError("The folder " + folder.string() + " cannot be read: " + error.message() + ".");
  return files;
}

bool completed_by_all(const EvaluatedCase& evaluated) {
  return std::all_of(evaluated.outcomes.begin(), evaluated.outcomes.end(),
                     [](const CaseOutcome& outcome) { return outcome.figures.has_value(); });
}

UncertaintyFigures uncertainty_figures(const ToothPrediction& tooth, const TriangleMesh& truth,
                                       const RootFigures& figures) {
  UncertaintyFigures result;
  result.interval = tooth.interval;
  result.source = tooth.source;
  result.apex_expected_distance_mm = tooth.apex_expected_distance_mm;
  result.length_mm = figures.true_root_length_mm + figures.root_length_error_mm;
  result.apex_distance_mm = figures.apex_distance_mm;
  for (const ApexPair& pair : figures.matched_apices)
    if (pair.predicted == 0) result.apex_distance_mm = pair.distance_mm;
  const ClosestPointIndex surface(truth);
  int count = 0;
  for (std::size_t v = 0; v < tooth.mesh.vertices.size(); ++v) {
    if (tooth.uncertainty[v] <= 0) continue;
    ++count;
    result.uncertainty_mm += tooth.uncertainty[v];
    result.surface_distance_mm += surface.closest(tooth.mesh.vertices[v]).distance;
  }
  result.uncertainty_mm /= std::max(count, 1);
  result.surface_distance_mm /= std::max(count, 1);
  return result;
}

}  // namespace

ToothPrediction prediction_of(const CompletedTooth& tooth) {
  return {tooth.mesh, tooth.record.root.interval, tooth.record.root.apex_expected_distance_mm, tooth.uncertainty,
          tooth.record.root.source};
}

CaseOutcome evaluate_case(const ToothPredictor& predict, int fdi, const TriangleMesh& crown, const TriangleMesh& truth,
                          const RootFigureOptions& options) {
  CaseOutcome outcome;
  try {
    const Eigen::Vector3d axis = crown_growth_axis(crown);
    const Stopwatch watch;
    const ToothPrediction tooth = predict(crown, fdi);
    outcome.seconds = watch.seconds();
    outcome.figures = root_figures(crown, truth, tooth.mesh, axis, options);
    if (!tooth.uncertainty.empty()) outcome.uncertainty = uncertainty_figures(tooth, truth, *outcome.figures);
  } catch (const UsageError&) {
    throw;
  } catch (const std::exception& error) {
    outcome.failure = error.what();
  }
  return outcome;
}

std::vector<EvaluationCase> find_evaluation_cases(const std::filesystem::path& folder) {
  const auto crowns = numbered_files(folder, "crown_"), teeth = numbered_files(folder, "tooth_");
  if (crowns.empty()) throw InputError("The folder " + folder.string() + " has no crown_FDI files.");
  std::vector<EvaluationCase> cases;
  for (const auto& [number, crown] : crowns) {
    const std::optional<int> fdi = tooth_of(number);
    if (!fdi)
      throw InputError("The number in the file name " + crown.filename().string() +
                       " is not that of a permanent tooth.");
    const auto tooth = teeth.find(number);
    if (tooth == teeth.end())
      throw InputError("The crown " + crown.filename().string() + " has no whole tooth tooth_" + number +
                       " beside it.");
    cases.push_back({*fdi, number.size() > 3 ? number.substr(3) : "", crown, tooth->second});
  }
  return cases;
}

bool Evaluation::has_failures() const { return !std::all_of(cases.begin(), cases.end(), completed_by_all); }

Evaluation evaluate_cases(const std::vector<EvaluationCase>& cases, const std::vector<NamedPredictor>& predictors,
                          const RootFigureOptions& options, const EvaluationProgress& progress) {
  Evaluation evaluation;
  for (const NamedPredictor& predictor : predictors) evaluation.predictors.push_back(predictor.name);
  for (std::size_t i = 0; i < cases.size(); ++i) {
    EvaluatedCase evaluated{cases[i], {}};
    TriangleMesh crown, truth;
    std::string unreadable;
    try {
      crown = load_mesh(cases[i].crown).mesh;
      truth = load_mesh(cases[i].truth).mesh;
    } catch (const InputError& error) {
      unreadable = error.what();
    }
    for (const NamedPredictor& predictor : predictors) {
      if (!unreadable.empty()) {
        evaluated.outcomes.push_back({std::nullopt, std::nullopt, unreadable, 0});
        continue;
      }
      if (progress) progress(cases[i], i, predictor.name);
      evaluated.outcomes.push_back(evaluate_case(predictor.predict, cases[i].fdi, crown, truth, options));
    }
    evaluation.cases.push_back(std::move(evaluated));
  }
  return evaluation;
}

MeanFigures mean_figures(const Evaluation& evaluation, std::size_t predictor, MeanOver over) {
  MeanFigures means;
  for (const EvaluatedCase& evaluated : evaluation.cases) {
    const std::optional<RootFigures>& figures = evaluated.outcomes.at(predictor).figures;
    if (!figures || (over == MeanOver::completed_by_all && !completed_by_all(evaluated))) continue;
    ++means.teeth;
    means.root_length_abs_error_mm += std::abs(figures->root_length_error_mm);
    means.root_length_bias_mm += figures->root_length_error_mm;
    means.apex_distance_mm += figures->apex_distance_mm;
    means.matched_apex_distance_mm += figures->matched_apex_distance_mm;
    means.root_chamfer_mm += figures->root_chamfer_mm;
    means.root_f_score += figures->root_f_score;
    means.root_hausdorff95_mm += figures->root_hausdorff95_mm;
    means.root_axis_angle_deg += figures->root_axis_angle_deg;
    means.chamfer_l2_e3 += figures->chamfer_l2_e3;
    means.f_score += figures->f_score;
    if (figures->furcation_height_error_mm) {
      ++means.furcations;
      means.furcation_height_error_mm += std::abs(*figures->furcation_height_error_mm);
    }
    means.right_root_counts += figures->true_apices.size() == figures->predicted_apices.size() ? 1 : 0;
  }
  if (means.furcations > 0) means.furcation_height_error_mm /= means.furcations;
  if (means.teeth == 0) return means;
  for (double* sum : {&means.root_length_abs_error_mm, &means.root_length_bias_mm, &means.apex_distance_mm,
                      &means.matched_apex_distance_mm, &means.root_chamfer_mm, &means.root_f_score,
                      &means.root_hausdorff95_mm, &means.root_axis_angle_deg, &means.chamfer_l2_e3, &means.f_score})
    *sum /= means.teeth;
  return means;
}

std::vector<std::pair<std::string, Evaluation>> split_by_type(const Evaluation& evaluation) {
  std::map<std::pair<bool, int>, Evaluation> parts;
  for (const EvaluatedCase& evaluated : evaluation.cases)
    parts[{evaluated.files.fdi >= 30, evaluated.files.fdi % 10}].cases.push_back(evaluated);
  std::vector<std::pair<std::string, Evaluation>> result;
  for (auto& [type, part] : parts) {
    part.predictors = evaluation.predictors;
    result.emplace_back((type.first ? "lower " : "upper ") + std::to_string(type.second), std::move(part));
  }
  return result;
}

}  // namespace rhizodont
