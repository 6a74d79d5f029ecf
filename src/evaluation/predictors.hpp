// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "evaluation/evaluate_cases.hpp"
#include "rhizodont/models.hpp"

#include <filesystem>

namespace rhizodont {

/// "rhizodont": `complete_tooth` with these options. `models` must outlive it.
NamedPredictor completing_predictor(const CompletionModels& models, const CompleteOptions& options);

/// "template": a library's tooth (`load_template_tooth`) laid on the crown by `fit_template`. Throws InputError if
/// there is no such folder; a template that is missing in it fails the tooth that needs it.
NamedPredictor template_predictor(const std::filesystem::path& folder);

}  // namespace rhizodont
