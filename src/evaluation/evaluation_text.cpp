// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluation/calibration.hpp"
#include "evaluation/evaluate_cases.hpp"

#include <fmt/format.h>

#include <iterator>

namespace rhizodont {
namespace {

using Json = nlohmann::ordered_json;

Json uncertainty_json(const UncertaintyFigures& figures) {
  Json json{{"apex_expected_distance_mm", figures.apex_expected_distance_mm},
            {"mean_uncertainty_mm", figures.uncertainty_mm},
            {"mean_distance_from_true_surface_mm", figures.surface_distance_mm}};
  if (figures.interval)
    json["interval"] = {{"length_low_mm", figures.interval->length_low_mm},
                        {"length_high_mm", figures.interval->length_high_mm},
                        {"apex_radius_mm", figures.interval->apex_radius_mm}};
  return json;
}

Json outcome_json(const CaseOutcome& outcome) {
  Json json{{"figures", nullptr}, {"failure", nullptr}};
  if (outcome.figures) {
    json["figures"] = *outcome.figures;
    json["seconds"] = outcome.seconds;
    if (outcome.uncertainty) json["uncertainty"] = uncertainty_json(*outcome.uncertainty);
  } else {
    json["failure"] = outcome.failure;
  }
  return json;
}

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) result += c == '"' ? std::string("\"\"") : std::string(1, c);
  return result + "\"";
}

/// Means of each predictor by the position of the tooth in upper or lower jaw, left and right together.
Json means_by_type_json(const Evaluation& evaluation) {
  Json json;
  for (const auto& [type, part] : split_by_type(evaluation))
    for (std::size_t p = 0; p < part.predictors.size(); ++p) json[type][part.predictors[p]] = mean_figures(part, p);
  return json;
}

}  // namespace

std::string describe(const CbctNoise& noise) {
  return fmt::format(
      "Noise of CBCT itself: root length of extracted premolars, 95 % limits {:+.2f} to {:+.2f} mm ({}); surface RMS "
      "{:.3f} to {:.3f} mm ({}).",
      noise.root_length_low_mm, noise.root_length_high_mm, noise.root_length_source, noise.surface_rms_low_mm,
      noise.surface_rms_high_mm, noise.surface_source);
}

void to_json(Json& json, const RootFigures& figures) {
  Json apices = Json::array();
  for (const ApexPair& pair : figures.matched_apices)
    apices.push_back({{"truth", pair.truth}, {"predicted", pair.predicted}, {"distance_mm", pair.distance_mm}});
  json = Json{{"true_root_length_mm", figures.true_root_length_mm},
              {"root_length_error_mm", figures.root_length_error_mm},
              {"apex_distance_mm", figures.apex_distance_mm},
              {"true_roots", figures.true_apices.size()},
              {"predicted_roots", figures.predicted_apices.size()},
              {"matched_apices", std::move(apices)},
              {"matched_apex_distance_mm", figures.matched_apex_distance_mm},
              {"furcation_height_error_mm", nullptr},
              {"root_chamfer_mm", figures.root_chamfer_mm},
              {"root_f_score", figures.root_f_score},
              {"root_hausdorff95_mm", figures.root_hausdorff95_mm},
              {"root_axis_angle_deg", figures.root_axis_angle_deg},
              {"chamfer_l2_e3", figures.chamfer_l2_e3},
              {"f_score", figures.f_score}};
  if (figures.furcation_height_error_mm) json["furcation_height_error_mm"] = *figures.furcation_height_error_mm;
}

void to_json(Json& json, const MeanFigures& means) {
  json = Json{{"teeth", means.teeth}};
  if (means.teeth == 0) return;
  json.update(Json{{"root_length_abs_error_mm", means.root_length_abs_error_mm},
                   {"root_length_bias_mm", means.root_length_bias_mm},
                   {"apex_distance_mm", means.apex_distance_mm},
                   {"matched_apex_distance_mm", means.matched_apex_distance_mm},
                   {"root_chamfer_mm", means.root_chamfer_mm},
                   {"root_f_score", means.root_f_score},
                   {"root_hausdorff95_mm", means.root_hausdorff95_mm},
                   {"root_axis_angle_deg", means.root_axis_angle_deg},
                   {"chamfer_l2_e3", means.chamfer_l2_e3},
                   {"f_score", means.f_score},
                   {"right_root_counts", means.right_root_counts}});
  if (means.furcations > 0) json["furcation_height_error_mm"] = means.furcation_height_error_mm;
}

void to_json(Json& json, const Evaluation& evaluation) {
  Json cases = Json::array(), means, common_means;
  for (const EvaluatedCase& evaluated : evaluation.cases) {
    Json outcomes;
    for (std::size_t p = 0; p < evaluation.predictors.size(); ++p)
      outcomes[evaluation.predictors[p]] = outcome_json(evaluated.outcomes[p]);
    cases.push_back({{"fdi", evaluated.files.fdi},
                     {"name", evaluated.files.name},
                     {"crown", evaluated.files.crown.filename().string()},
                     {"truth", evaluated.files.truth.filename().string()},
                     {"outcomes", std::move(outcomes)}});
  }
  Json coverages;
  for (std::size_t p = 0; p < evaluation.predictors.size(); ++p) {
    coverages[evaluation.predictors[p]] = coverage(evaluation, p);
    means[evaluation.predictors[p]] = mean_figures(evaluation, p);
    common_means[evaluation.predictors[p]] = mean_figures(evaluation, p, MeanOver::completed_by_all);
  }
  const CbctNoise noise;
  json = Json{{"cases", std::move(cases)},
              {"means", std::move(means)},
              {"coverage", std::move(coverages)},
              {"means_by_type", means_by_type_json(evaluation)},
              {"means_of_common_teeth", std::move(common_means)},
              {"cbct_noise",
               {{"root_length_95_limits_mm", {noise.root_length_low_mm, noise.root_length_high_mm}},
                {"root_length_source", noise.root_length_source},
                {"surface_rms_mm", {noise.surface_rms_low_mm, noise.surface_rms_high_mm}},
                {"surface_source", noise.surface_source}}}};
}

std::string evaluation_csv(const Evaluation& evaluation) {
  std::string csv =
      "fdi,name,predictor,true_root_length_mm,root_length_error_mm,apex_distance_mm,true_roots,predicted_roots,"
      "matched_apex_distance_mm,furcation_height_error_mm,root_chamfer_mm,root_f_score,root_hausdorff95_mm,root_axis_"
      "angle_deg,chamfer_l2_e3,"
      "f_score,seconds,failure\n";
  for (const EvaluatedCase& evaluated : evaluation.cases)
    for (std::size_t p = 0; p < evaluation.predictors.size(); ++p) {
      const CaseOutcome& outcome = evaluated.outcomes[p];
      fmt::format_to(std::back_inserter(csv), "{},{},{},", evaluated.files.fdi, quoted(evaluated.files.name),
                     quoted(evaluation.predictors[p]));
      if (const auto& f = outcome.figures)
        fmt::format_to(std::back_inserter(csv),
                       "{:.6g},{:.6g},{:.6g},{},{},{:.6g},{},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.3f},\n",
                       f->true_root_length_mm, f->root_length_error_mm, f->apex_distance_mm, f->true_apices.size(),
                       f->predicted_apices.size(), f->matched_apex_distance_mm,
                       f->furcation_height_error_mm ? fmt::format("{:.6g}", *f->furcation_height_error_mm) : "",
                       f->root_chamfer_mm, f->root_f_score, f->root_hausdorff95_mm, f->root_axis_angle_deg,
                       f->chamfer_l2_e3, f->f_score, outcome.seconds);
      else
        csv += std::string(14, ',') + quoted(outcome.failure) + "\n";
    }
  return csv;
}

}  // namespace rhizodont
