// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "rhizodont/evaluate.hpp"

#include "evaluation/evaluate_cases.hpp"
#include "evaluation/predictors.hpp"
#include "report/json.hpp"
#include "rhizodont/error.hpp"

namespace rhizodont {

std::string evaluate_to_json(const std::filesystem::path& cases, const CompletionModels& models,
                             const EvaluateOptions& options, const EvaluateProgress& progress) {
  if (options.tooth.fdi) throw UsageError("The numbers of teeth to be evaluated are those in their files' names.");
  const std::vector<EvaluationCase> all = find_evaluation_cases(cases);
  std::vector<NamedPredictor> predictors{completing_predictor(models, options.tooth)};
  if (!options.templates.empty()) predictors.push_back(template_predictor(options.templates));
  EvaluationProgress callback;
  if (progress)
    callback = [&](const EvaluationCase& files, std::size_t place, const std::string& predictor) {
      progress(files.fdi, static_cast<int>(place), static_cast<int>(all.size()), predictor);
    };
  return text_of(evaluate_cases(all, predictors, {}, callback));
}

std::string root_figures_to_json(const TriangleMesh& crown, const TriangleMesh& truth, const TriangleMesh& predicted) {
  return text_of(root_figures(crown, truth, predicted, crown_growth_axis(crown)));
}

}  // namespace rhizodont
