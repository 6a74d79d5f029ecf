// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluation/predictors.hpp"

#include "evaluation/template_predictor.hpp"
#include "rhizodont/error.hpp"

#include <system_error>

namespace rhizodont {

NamedPredictor completing_predictor(const CompletionModels& models, const CompleteOptions& options) {
  return {"rhizodont", [&models, options](const TriangleMesh& crown, int fdi) {
            CompleteOptions of_this = options;
            of_this.fdi = fdi;
            return prediction_of(complete_tooth(crown, models, of_this));
          }};
}

NamedPredictor template_predictor(const std::filesystem::path& folder) {
  std::error_code ignored;
  if (!std::filesystem::is_directory(folder, ignored))
    throw InputError("There is no folder " + folder.string() + ", where the templates should be.");
  return {"template", [folder](const TriangleMesh& crown, int fdi) {
            return ToothPrediction{fit_template(crown, load_template_tooth(folder, fdi)), {}, 0, {}};
          }};
}

}  // namespace rhizodont
