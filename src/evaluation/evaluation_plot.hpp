// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "evaluation/evaluate_cases.hpp"

#include <string>

namespace rhizodont {

/// Predicted against true root length of each tooth as a drawing (SVG text): one colour per predictor, intervals as
/// upright lines where the predictor gives them, and the band within which cone-beam computed tomography itself agrees
/// with extracted teeth. Throws NoResultError if no tooth has figures.
std::string root_length_plot(const Evaluation& evaluation);

}  // namespace rhizodont
