// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "completion/uncertainty.hpp"
#include "evaluation/evaluate_cases.hpp"

#include <cstddef>
#include <map>
#include <string>

namespace rhizodont {

/// How often the truth lay where it was said to lie, over the teeth with an interval.
struct Coverage {
  int teeth = 0;
  double length = 0;             ///< share of true root lengths inside of their intervals
  double apex = 0;               ///< share of true apices inside of their balls
  double interval_width_mm = 0;  ///< mean
};
Coverage coverage(const Evaluation& evaluation, std::size_t predictor);

/// The scales with which 80 % of these teeth's lengths and apices would lie where they are said to, and the uncertainty
/// per vertex would be right on average (split conformal prediction, see `UncertaintyScales`). `used`: the scales with
/// which the teeth were completed. Throws UsageError for fewer than 20 teeth with figures.
UncertaintyScales calibrate(const Evaluation& evaluation, std::size_t predictor, const UncertaintyScales& used);

/// `calibrate` for the weights with which these teeth were completed: their scales, and from how many teeth they come,
/// go into the weights' metadata. Returns the scales. Throws as `calibrate`.
UncertaintyScales calibrate_weights(const Evaluation& evaluation, std::size_t predictor,
                                    std::map<std::string, std::string>& metadata);

/// For `nlohmann::ordered_json(value)`.
void to_json(nlohmann::ordered_json& json, const Coverage& coverage);

}  // namespace rhizodont
