// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "completion/uncertainty.hpp"
#include "evaluation/evaluate_cases.hpp"

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace rhizodont {

/// What was predicted of a root and what is true of it: what intervals are scaled by. Lengths lie below the crown's
/// lowest place, along its axis.
struct RootOutcome {
  int fdi = 0;
  double length_mm = 0, true_length_mm = 0;
  double apex_distance_mm = 0;      ///< of the predicted apex from the true one
  double expected_distance_mm = 0;  ///< > 0: what the network expects of its deepest points, before calibration
};
/// The teeth with figures whose predictor says how sure it is.
std::vector<RootOutcome> root_outcomes(const Evaluation& evaluation, std::size_t predictor);

/// How often the truth lay where it was said to lie, over the teeth with an interval.
struct Coverage {
  int teeth = 0;
  double length = 0;             ///< share of true root lengths inside of their intervals
  double apex = 0;               ///< share of true apices inside of their balls
  double interval_width_mm = 0;  ///< mean
};
Coverage coverage(const Evaluation& evaluation, std::size_t predictor);
/// The same for intervals as weights with this metadata state them; none where these were never calibrated.
Coverage coverage(const std::vector<RootOutcome>& roots, const std::map<std::string, std::string>& metadata);

/// The scales with which 80 % of these roots' lengths and apices would lie where they are said to (split conformal
/// prediction, see `UncertaintyScales`). `surface` is taken over. Throws UsageError for fewer than 20 roots.
UncertaintyScales interval_scales(const std::vector<RootOutcome>& roots, double surface);
/// The same for each type with at least `fewest` (>= 20) of the roots, by the FDI number of the type's left tooth.
std::map<int, UncertaintyScales> interval_scales_by_type(const std::vector<RootOutcome>& roots, double surface,
                                                         std::size_t fewest = 50);

/// The factor with which the uncertainty per vertex would be right on average over these teeth. `used`: that with which
/// they were completed, > 0. Throws UsageError where no predicted tooth says how sure it is.
double surface_scale(const Evaluation& evaluation, std::size_t predictor, double used);

/// `interval_scales` and `surface_scale` of these teeth. `used`: the scales with which they were completed. Throws as
/// these.
UncertaintyScales calibrate(const Evaluation& evaluation, std::size_t predictor, const UncertaintyScales& used);

/// `calibrate` for the weights with which these teeth were completed: their scales, those of types with enough teeth,
/// and from how many teeth they come, go into the weights' metadata. Returns the scales of all. Throws as `calibrate`.
UncertaintyScales calibrate_weights(const Evaluation& evaluation, std::size_t predictor,
                                    std::map<std::string, std::string>& metadata);

/// For `nlohmann::ordered_json(value)`.
void to_json(nlohmann::ordered_json& json, const Coverage& coverage);

}  // namespace rhizodont
