// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "command_line/output_checks.hpp"
#include "command_line/output_options.hpp"
#include "commands.hpp"
#include "evaluation/people_calibration.hpp"
#include "networks/safetensors.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/models.hpp"
#include "rhizodont/output_files.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
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

void run(const CalibrateCommand& command) {
  const std::filesystem::path weights = command.models / "completion.safetensors";
  std::vector<std::filesystem::path> outputs{weights};
  if (!command.text.empty()) {
    require_no_mesh_ending(command.text, "a text");
    require_separate_files(model_files(command.models), {command.text});
    outputs.push_back(command.text);
  }
  require_safe_outputs(files_below(command.data), outputs);
  FamilyLoadOptions population;
  population.population = command.population;
  population.registered = command.registered;
  const ToothFamilies families = load_tooth_families(command.data, population);
  const CompletionModels models = CompletionModels::load(command.models);
  PeopleCalibrationOptions options = command.options;
  if (!command.said.is_quiet() && isatty(STDERR_FILENO))
    options.progress = [](std::size_t done, std::size_t of) {
      fmt::print(stderr, "\r\033[Ktooth {} of {} ...", done, of);
      if (done == of) fmt::print(stderr, "\r\033[K");
    };
  const PeopleCalibration calibration = calibrate_on_people(families, models, options);
  TensorFile file = read_safetensors(weights);
  note_calibration(calibration, file.metadata);
  const std::string text = calibration_text(calibration);
  std::vector<OutputFile> results{{weights, safetensors_bytes(file)}};
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
                   "Lengths of a type whose median is off by more are corrected, mm")
      ->capture_default_str();
  calibrate->add_option("--threads", command->options.threads, "At most so many threads; 0 = all")
      ->capture_default_str();
  calibrate->add_option("--text", command->text, "Write the table for the model card to this file too (.md)");
  command->said.add_to(*calibrate);
  calibrate->callback([command] { run(*command); });
}

}  // namespace rhizodont::command_line
