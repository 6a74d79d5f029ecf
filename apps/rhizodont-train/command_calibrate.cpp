// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "command_line/output_checks.hpp"
#include "command_line/output_options.hpp"
#include "command_line/progress_line.hpp"
#include "commands.hpp"
#include "evaluation/people_calibration.hpp"
#include "networks/safetensors.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/models.hpp"
#include "rhizodont/output_files.hpp"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace rhizodont::command_line {
namespace {

struct CalibrateCommand {
  std::filesystem::path data, models, population, registered, text;
  PeopleCalibrationOptions options;
  OutputOptions said;
};

nlohmann::ordered_json figures_of(const UncertaintyScales& scales) {
  return {{"length_low", scales.length_low},
          {"length_high", scales.length_high},
          {"apex", scales.apex},
          {"surface", scales.surface}};
}

nlohmann::ordered_json figures_of(const PeopleCalibration& calibration) {
  const auto of_type = [](const std::map<int, double>& figures, int fdi) {
    const auto found = figures.find(fdi);
    return found == figures.end() ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(found->second);
  };
  nlohmann::ordered_json types = nlohmann::ordered_json::array();
  for (const auto& [fdi, scales] : calibration.types)
    types.push_back({{"fdi", fdi},
                     {"scales", figures_of(scales)},
                     {"bias_mm", of_type(calibration.bias_mm, fdi)},
                     {"median_bias_mm", of_type(calibration.median_bias_mm, fdi)},
                     {"correction_mm", of_type(calibration.correction_mm, fdi)},
                     {"surface_longer_mm", of_type(calibration.surface_longer_mm, fdi)}});
  return {{"predicted", calibration.predicted},
          {"completed", calibration.completed},
          {"scales", figures_of(calibration.all)},
          {"types", types}};
}

/// The weights are read and written, all else that is read stays as it is.
void require_safe_places(const CalibrateCommand& command, const std::filesystem::path& weights) {
  std::vector<std::filesystem::path> outputs = command.said.outputs();
  if (!command.text.empty()) {
    require_no_mesh_ending(command.text, "a text");
    outputs.push_back(command.text);
  }
  require_separate_files(model_files(command.models), outputs);
  outputs.push_back(weights);
  std::vector<std::filesystem::path> inputs = files_below(command.data);
  if (!command.population.empty()) inputs.push_back(command.population);
  if (!command.registered.empty())
    for (const std::filesystem::path& file : files_below(command.registered)) inputs.push_back(file);
  require_safe_outputs(inputs, outputs);
}

void run(const CalibrateCommand& command) {
  const std::filesystem::path weights = command.models / "completion.safetensors";
  require_safe_places(command, weights);
  FamilyLoadOptions population;
  population.population = command.population;
  population.registered = command.registered;
  const ToothFamilies families = load_tooth_families(command.data, population);
  const CompletionModels models = CompletionModels::load(command.models);
  PeopleCalibrationOptions options = command.options;
  ProgressLine line(command.said);
  if (line.is_shown())
    options.progress = [&line](std::size_t done, std::size_t of) {
      line.say(fmt::format("tooth {} of {} ...", done, of));
    };
  const PeopleCalibration calibration = calibrate_on_people(families, models, options);
  line.clear();
  TensorFile file = read_safetensors(weights);
  note_calibration(calibration, file.metadata);
  const std::string text = calibration_text(calibration);
  std::vector<OutputFile> results = command.said.print_or_file(figures_of(calibration));
  results.push_back({weights, safetensors_bytes(file)});
  if (!command.text.empty()) results.push_back({command.text, text});
  write_output_files(results);
  command.said.tell(text);
}

}  // namespace

void add_calibrate_command(CLI::App& app) {
  auto command = std::make_shared<CalibrateCommand>();
  CLI::App* calibrate = app.add_subcommand(
      "calibrate", "Scale a completion network's intervals by tooth type on generated people, and correct its lengths");
  calibrate->add_option("--data", command->data, "Folder with templates/, anatomy.csv and crowns/ssm/")->required();
  calibrate
      ->add_option("--models", command->models,
                   "Folder with atlas.safetensors and completion.safetensors; the latter is written to")
      ->required();
  calibrate->add_option(
      "--population", command->population,
      "JSON table of lengths, roots and curves by tooth; without it the middle of published populations");
  calibrate->add_option("--registered", command->registered,
                        "Folder of registered teeth (rhizodont register): each is a further template of its type");
  calibrate->add_option("--people", command->options.people, "People, one tooth of each type of each")
      ->capture_default_str();
  calibrate->add_option("--completed", command->options.completed, "Of how many of them teeth are completed as well")
      ->capture_default_str();
  calibrate
      ->add_option("--largest-bias", command->options.largest_bias_mm,
                   "Lengths of a type that are off by more in the mean are corrected to this, mm")
      ->capture_default_str();
  calibrate->add_option("--threads", command->options.threads, "At most so many threads; 0 = all")
      ->capture_default_str();
  calibrate->add_option("--text", command->text, "Write the table for the model card to this file too (.md)");
  command->said.add_with_figures_to(*calibrate);
  calibrate->callback([command] { run(*command); });
}

}  // namespace rhizodont::command_line
