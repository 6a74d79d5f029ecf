// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// Intervals whose scale is a quantile on held-out teeth: H. Papadopoulos et al., "Inductive confidence machines for
// regression", 2002.
#include "evaluation/calibration.hpp"

#include "base/conformal_quantile.hpp"
#include "rhizodont/error.hpp"
#include "teeth/fdi.hpp"

#include <optional>
#include <vector>

namespace rhizodont {
Coverage coverage(const Evaluation& evaluation, std::size_t predictor) {
  Coverage result;
  for (const EvaluatedCase& evaluated : evaluation.cases) {
    const CaseOutcome& outcome = evaluated.outcomes.at(predictor);
    if (!outcome.figures || !outcome.uncertainty || !outcome.uncertainty->interval) continue;
    const RootInterval& interval = *outcome.uncertainty->interval;
    const double truth = outcome.figures->true_root_length_mm;
    ++result.teeth;
    result.length += truth >= interval.length_low_mm && truth <= interval.length_high_mm ? 1 : 0;
    result.apex += outcome.uncertainty->apex_distance_mm <= interval.apex_radius_mm ? 1 : 0;
    result.interval_width_mm += interval.length_high_mm - interval.length_low_mm;
  }
  if (result.teeth > 0)
    for (double* sum : {&result.length, &result.apex, &result.interval_width_mm}) *sum /= result.teeth;
  return result;
}

Coverage coverage(const std::vector<RootOutcome>& roots, const std::map<std::string, std::string>& metadata) {
  Coverage result;
  for (const RootOutcome& root : roots) {
    const std::optional<UncertaintyScales> scales = uncertainty_scales(metadata, root.fdi);
    if (!scales) continue;
    const auto [low, high] = length_interval(root.length_mm, root.expected_distance_mm, *scales);
    ++result.teeth;
    result.length += root.true_length_mm >= low && root.true_length_mm <= high ? 1 : 0;
    result.apex += root.apex_distance_mm <= scales->apex * root.expected_distance_mm ? 1 : 0;
    result.interval_width_mm += high - low;
  }
  if (result.teeth > 0)
    for (double* sum : {&result.length, &result.apex, &result.interval_width_mm}) *sum /= result.teeth;
  return result;
}

std::vector<RootOutcome> root_outcomes(const Evaluation& evaluation, std::size_t predictor) {
  std::vector<RootOutcome> roots;
  for (const EvaluatedCase& evaluated : evaluation.cases) {
    const CaseOutcome& outcome = evaluated.outcomes.at(predictor);
    if (!outcome.figures || !outcome.uncertainty || !(outcome.uncertainty->apex_expected_distance_mm > 0)) continue;
    const UncertaintyFigures& u = *outcome.uncertainty;
    roots.push_back({evaluated.files.fdi, u.length_mm, outcome.figures->true_root_length_mm, u.apex_distance_mm,
                     u.apex_expected_distance_mm});
  }
  return roots;
}

UncertaintyScales interval_scales(const std::vector<RootOutcome>& roots, double surface) {
  constexpr std::size_t fewest = 20;
  if (roots.size() < fewest) throw UsageError("Calibration needs at least 20 teeth whose roots were predicted.");
  std::vector<double> longer, shorter, apex;
  for (const RootOutcome& root : roots) {
    longer.push_back((root.true_length_mm - root.length_mm) / root.expected_distance_mm);
    shorter.push_back(-longer.back());
    apex.push_back(root.apex_distance_mm / root.expected_distance_mm);
  }
  return {-conformal_quantile(shorter, 0.9), conformal_quantile(longer, 0.9), conformal_quantile(apex, 0.8), surface};
}

std::map<int, UncertaintyScales> interval_scales_by_type(const std::vector<RootOutcome>& roots, double surface,
                                                         std::size_t fewest) {
  std::map<int, std::vector<RootOutcome>> by_type;
  for (const RootOutcome& root : roots) by_type[fdi_of_type(tooth_type_of_fdi(root.fdi), false)].push_back(root);
  std::map<int, UncertaintyScales> scales;
  for (const auto& [fdi, of_type] : by_type)
    if (of_type.size() >= fewest) scales[fdi] = interval_scales(of_type, surface);
  return scales;
}

double surface_scale(const Evaluation& evaluation, std::size_t predictor, double used) {
  double said = 0, measured = 0;
  for (const EvaluatedCase& evaluated : evaluation.cases) {
    const CaseOutcome& outcome = evaluated.outcomes.at(predictor);
    if (!outcome.figures || !outcome.uncertainty || !(outcome.uncertainty->apex_expected_distance_mm > 0)) continue;
    said += outcome.uncertainty->uncertainty_mm / used;
    measured += outcome.uncertainty->surface_distance_mm;
  }
  if (!(said > 0)) throw UsageError("No tooth was completed that says how sure its prediction is.");
  return measured / said;
}

UncertaintyScales calibrate(const Evaluation& evaluation, std::size_t predictor, const UncertaintyScales& used) {
  UncertaintyScales scales = interval_scales(root_outcomes(evaluation, predictor), used.surface);
  scales.surface = surface_scale(evaluation, predictor, used.surface);
  return scales;
}

UncertaintyScales calibrate_weights(const Evaluation& evaluation, std::size_t predictor,
                                    std::map<std::string, std::string>& metadata) {
  const UncertaintyScales used = uncertainty_scales(metadata).value_or(UncertaintyScales{0, 0, 0, 1});
  const UncertaintyScales scales = calibrate(evaluation, predictor, used);
  note_uncertainty_scales(scales, metadata,
                          interval_scales_by_type(root_outcomes(evaluation, predictor), scales.surface));
  metadata["uncertainty.teeth"] = std::to_string(mean_figures(evaluation, predictor).teeth);
  return scales;
}

void to_json(nlohmann::ordered_json& json, const Coverage& coverage) {
  json = {{"teeth", coverage.teeth}};
  if (coverage.teeth == 0) return;
  json["probability"] = 0.8;
  json["share_of_lengths_inside"] = coverage.length;
  json["share_of_apices_inside"] = coverage.apex;
  json["mean_interval_width_mm"] = coverage.interval_width_mm;
}

}  // namespace rhizodont
