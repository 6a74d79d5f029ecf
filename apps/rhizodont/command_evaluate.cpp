// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "command_line/output_checks.hpp"
#include "command_line/output_options.hpp"
#include "command_line/progress_line.hpp"
#include "commands.hpp"
#include "evaluate_labels.hpp"
#include "evaluation/calibration.hpp"
#include "evaluation/evaluate_cases.hpp"
#include "evaluation/evaluation_plot.hpp"
#include "evaluation/predictors.hpp"
#include "models_option.hpp"
#include "networks/safetensors.hpp"
#include "report/html_report.hpp"
#include "report/json.hpp"
#include "rhizodont/complete.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/hash.hpp"
#include "rhizodont/io.hpp"
#include "rhizodont/version.hpp"

#include <fmt/core.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace rhizodont::command_line {
namespace {

struct EvaluateCommand {
  std::string cases, templates, models, csv, plot, report, calibrate, labels;
  OutputOptions said;
  CompleteOptions options;
};

/// Says which tooth is at work.
EvaluationProgress progress_on(ProgressLine& line, std::size_t cases) {
  if (!line.is_shown()) return {};
  return [&line, cases](const EvaluationCase& files, std::size_t place, const std::string& predictor) {
    line.say(fmt::format("tooth {} ({} of {}), {} ...", files.fdi, place + 1, cases, predictor));
  };
}

void print_header() {
  constexpr const char* columns = "{:<9}{:<10}{:>8}{:>8}{:>8}{:>9}{:>8}{:>8}{:>8}{:>10}{:>8}{:>10}\n";
  fmt::print(columns, "", "", "length", "apex", "matched", "root", "root F", "root", "axis", "Chamfer", "F at",
             "roots");
  fmt::print(columns, "FDI", "by", "error", "off", "apices", "Chamfer", "0.5 mm", "H 95 %", "angle", "L2 x1000", "1 %",
             "true:got");
}

void print_row(int fdi, const std::string& predictor, const CaseOutcome& outcome) {
  if (!outcome.figures) {
    fmt::print("{:<9}{:<10}  no figures: {}\n", fdi, predictor, outcome.failure);
    return;
  }
  const RootFigures& f = *outcome.figures;
  fmt::print("{:<9}{:<10}{:>+8.2f}{:>8.2f}{:>8.2f}{:>9.3f}{:>8.3f}{:>8.2f}{:>8.1f}{:>10.3f}{:>8.3f}{:>10}\n", fdi,
             predictor, f.root_length_error_mm, f.apex_distance_mm, f.matched_apex_distance_mm, f.root_chamfer_mm,
             f.root_f_score, f.root_hausdorff95_mm, f.root_axis_angle_deg, f.chamfer_l2_e3, f.f_score,
             fmt::format("{}:{}", f.true_apices.size(), f.predicted_apices.size()));
}

void print_mean(const char* name, const std::string& predictor, const MeanFigures& m) {
  if (m.teeth == 0) {
    fmt::print("{:<9}{:<10}  no tooth\n", name, predictor);
    return;
  }
  fmt::print("{:<9}{:<10}{:>8.2f}{:>8.2f}{:>8.2f}{:>9.3f}{:>8.3f}{:>8.2f}{:>8.1f}{:>10.3f}{:>8.3f}{:>10}\n", name,
             predictor, m.root_length_abs_error_mm, m.apex_distance_mm, m.matched_apex_distance_mm, m.root_chamfer_mm,
             m.root_f_score, m.root_hausdorff95_mm, m.root_axis_angle_deg, m.chamfer_l2_e3, m.f_score,
             fmt::format("{}/{}", m.right_root_counts, m.teeth));
}

void print_means(const Evaluation& evaluation) {
  const auto& names = evaluation.predictors;
  for (std::size_t p = 0; p < names.size(); ++p) print_mean("mean", names[p], mean_figures(evaluation, p));
  if (names.size() > 1 && evaluation.has_failures()) {
    fmt::print("over the teeth that all completed:\n");
    for (std::size_t p = 0; p < names.size(); ++p)
      print_mean("mean", names[p], mean_figures(evaluation, p, MeanOver::completed_by_all));
  }
  for (const auto& [type, part] : split_by_type(evaluation))
    if (part.cases.size() > 2)
      for (std::size_t p = 0; p < names.size(); ++p) print_mean(type.c_str(), names[p], mean_figures(part, p));
  for (std::size_t p = 0; p < names.size(); ++p) {
    const MeanFigures means = mean_figures(evaluation, p);
    fmt::print("{}: {} of {} teeth completed, bias of the root's length {:+.2f} mm\n", names[p], means.teeth,
               evaluation.cases.size(), means.root_length_bias_mm);
    if (means.furcations > 0)
      fmt::print("{}: height of the furcation off by {:.2f} mm (mean of {} teeth)\n", names[p],
                 means.furcation_height_error_mm, means.furcations);
    if (const Coverage c = coverage(evaluation, p); c.teeth > 0)
      fmt::print(
          "{}: intervals of 80 % hold {:.0f} % of the root lengths (mean width {:.1f} mm) and {:.0f} % of the "
          "apices\n",
          names[p], 100 * c.length, c.interval_width_mm, 100 * c.apex);
  }
}

void print_table(const Evaluation& evaluation) {
  print_header();
  for (const EvaluatedCase& evaluated : evaluation.cases)
    for (std::size_t p = 0; p < evaluation.predictors.size(); ++p)
      print_row(evaluated.files.fdi, evaluation.predictors[p], evaluated.outcomes[p]);
  fmt::print("\n");
  print_means(evaluation);
  fmt::print(
      "Lengths in mm along the crown's growth axis, means of the length error over absolute values. Root: what lies "
      "below the crown's\nlowest point. H 95 %: Hausdorff distance, 95th percentile. Axis angle in degrees. Chamfer L2 "
      "and F at 1 %: whole tooth, in units\nof the diagonal of its bounding box.\n");
  fmt::print("{}\n", describe(CbctNoise{}));
}

/// The weight file with which these teeth were completed, with the scales that they call for.
OutputFile calibrated_weights(const EvaluateCommand& command, const Evaluation& evaluation) {
  TensorFile weights = read_safetensors(command.calibrate);
  const UncertaintyScales scales = calibrate_weights(evaluation, 0, weights.metadata);
  if (command.said.wants_words())
    fmt::print("{}: root length {:+.2f} to {:+.2f}, apex {:.2f}, surface {:.2f} times the expected distance\n",
               command.calibrate, scales.length_low, scales.length_high, scales.apex, scales.surface);
  return {command.calibrate, safetensors_bytes(weights)};
}

/// Before hours of work: none of the results may cost a tooth, a template or the weights; the weights themselves are
/// written to only where that was asked for.
void require_safe_places(const EvaluateCommand& command, const std::vector<EvaluationCase>& cases) {
  std::vector<std::filesystem::path> inputs = files_below(command.templates);
  for (const EvaluationCase& files : cases) inputs.insert(inputs.end(), {files.crown, files.truth});
  std::vector<std::filesystem::path> outputs = command.said.outputs();
  for (const std::string* file : {&command.csv, &command.plot, &command.report}) {
    if (file->empty()) continue;
    require_no_mesh_ending(*file, "a table, a plot or a page");
    outputs.emplace_back(*file);
  }
  require_separate_files(model_files(models_folder(command.models, command.said)), outputs);
  if (!command.calibrate.empty()) outputs.emplace_back(command.calibrate);
  require_safe_outputs(inputs, outputs);
}

/// Figures, plot and where they come from, as a page in one file.
std::string page_of(const EvaluateCommand& command, const std::vector<EvaluationCase>& cases,
                    const Evaluation& evaluation) {
  std::string hashes;  // of all crowns and true teeth, in the order of the cases
  for (const EvaluationCase& files : cases)
    for (const std::filesystem::path& file : {files.crown, files.truth})
      hashes += sha256_of_bytes(read_file_bytes(file)) + "\n";
  nlohmann::ordered_json report{{"program", {{"name", "rhizodont"}, {"version", RHIZODONT_VERSION}}},
                                {"notice", "Predicted roots are not the patient's anatomy. For research only."},
                                {"input", {{"file", nullptr}, {"sha256", sha256_of_bytes(hashes)}}},
                                {"options", {{"e_mm", command.options.e}}},
                                {"evaluation", evaluation},
                                {"scanner_limits", describe(CbctNoise{})}};
  const bool has_figures = mean_figures(evaluation, 0).teeth > 0;
  return html_report(text_of(report), {{},
                                       has_figures ? root_length_plot(evaluation) : "",
                                       hashes_of(model_files(models_folder(command.models, command.said)))});
}

void run(const EvaluateCommand& command) {
  if (!command.report.empty()) {
    if (!is_page_name(command.report)) throw UsageError("--report is a page to look at: give it a name in .html.");
    require_report_page();
  }
  const std::vector<EvaluationCase> cases = find_evaluation_cases(command.cases);
  require_safe_places(command, cases);
  const CompletionModels models = CompletionModels::load(models_folder(command.models, command.said));
  std::vector<NamedPredictor> predictors{completing_predictor(models, command.options)};
  if (!command.templates.empty()) predictors.push_back(template_predictor(command.templates));
  ProgressLine line(command.said);
  const Evaluation evaluation = evaluate_cases(cases, predictors, {}, progress_on(line, cases.size()));
  line.clear();
  if (command.said.wants_words()) print_table(evaluation);
  std::vector<OutputFile> results = command.said.print_or_file(evaluation);
  if (!command.csv.empty()) results.push_back({command.csv, evaluation_csv(evaluation)});
  if (!command.plot.empty()) results.push_back({command.plot, root_length_plot(evaluation)});
  if (!command.report.empty()) results.push_back({command.report, page_of(command, cases, evaluation)});
  if (!command.calibrate.empty()) results.push_back(calibrated_weights(command, evaluation));
  write_output_files(results);
  if (evaluation.has_failures()) exit_with(static_cast<int>(ErrorCode::no_result));
}

}  // namespace

void add_evaluate_command(CLI::App& app) {
  auto command = std::make_shared<EvaluateCommand>();
  CLI::App* evaluate = app.add_subcommand(
      "evaluate", "Complete crowns whose whole teeth are known and measure how far the roots are off (exit 0 or 4)");
  evaluate->add_option("CASES_DIR", command->cases, "Folder with crown_FDI and tooth_FDI (or _FDI_NAME) meshes in mm")
      ->required();
  evaluate->add_option("--templates", command->templates,
                       "Folder with tooth_FDI.ply of the left side: the simple predictor's figures stand beside");
  evaluate->add_option("--e", command->options.e, "Side of the lattice in mm, 0.2 to 2")->capture_default_str();
  evaluate->add_option("--threads", command->options.threads, "At most so many threads; 0 = all")
      ->capture_default_str();
  add_models_option(*evaluate, command->models);
  evaluate->add_option("--csv", command->csv, "Write one line per tooth and predictor to this file");
  evaluate->add_option("--plot", command->plot, "Draw predicted against true root lengths to this SVG file");
  evaluate->add_option("--report", command->report, "Write tables, plot and provenance as a page in one file (.html)");
  evaluate->add_option(
      "--calibrate", command->calibrate,
      "Scale the intervals in this weight file (--models' completion.safetensors) to these teeth, which "
      "must not have been trained on");
  evaluate->add_option("--labels", command->labels,
                       "Instead: CASES_DIR has scans with true labels (SCAN.json) beside them; this folder has the "
                       "labels to judge, a SCAN.json each");
  command->said.add_with_figures_to(*evaluate);
  evaluate->callback([command] {
    if (!command->labels.empty()) {
      evaluate_labels(command->cases, command->labels, command->said);
      return;
    }
    run(*command);
  });
}

}  // namespace rhizodont::command_line
