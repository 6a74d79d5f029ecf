// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// Intervals whose scale is a quantile on held-out teeth: H. Papadopoulos et al., "Inductive confidence machines for
// regression", 2002.
#include "evaluation/calibration.hpp"

#include "base/conformal_quantile.hpp"
#include "rhizodont/error.hpp"

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

UncertaintyScales calibrate(const Evaluation& evaluation, std::size_t predictor, const UncertaintyScales& used) {
  constexpr std::size_t fewest = 20;
  std::vector<double> length, apex;
  double said = 0, measured = 0;
  for (const EvaluatedCase& evaluated : evaluation.cases) {
    const CaseOutcome& outcome = evaluated.outcomes.at(predictor);
    if (!outcome.figures || !outcome.uncertainty || !(outcome.uncertainty->apex_expected_distance_mm > 0)) continue;
    const UncertaintyFigures& u = *outcome.uncertainty;
    length.push_back((outcome.figures->true_root_length_mm - u.length_mm) / u.apex_expected_distance_mm);
    apex.push_back(u.apex_distance_mm / u.apex_expected_distance_mm);
    said += u.uncertainty_mm / used.surface;
    measured += u.surface_distance_mm;
  }
  if (length.size() < fewest) throw UsageError("Calibration needs at least 20 teeth whose roots were predicted.");
  std::vector<double> turned = length;
  for (double& value : turned) value = -value;
  return {-conformal_quantile(turned, 0.9), conformal_quantile(length, 0.9), conformal_quantile(apex, 0.8),
          measured / said};
}

UncertaintyScales calibrate_weights(const Evaluation& evaluation, std::size_t predictor,
                                    std::map<std::string, std::string>& metadata) {
  const UncertaintyScales used = uncertainty_scales(metadata).value_or(UncertaintyScales{0, 0, 0, 1});
  const UncertaintyScales scales = calibrate(evaluation, predictor, used);
  note_uncertainty_scales(scales, metadata);
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
