// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "command_line/output_checks.hpp"
#include "command_line/output_options.hpp"
#include "commands.hpp"
#include "learning/train_classifier.hpp"
#include "networks/safetensors.hpp"
#include "rhizodont/error.hpp"
#include "training/likeness_samples.hpp"
#include "training_output.hpp"

#include <fmt/core.h>

#include <filesystem>
#include <memory>
#include <string>

namespace rhizodont::command_line {
namespace {

struct LikenessCommand {
  std::filesystem::path data, weights;
  int teeth = 420;
  int held_out = 150;
  bool bounds_only = false;
  ClassifierTrainingOptions options;
  OutputOptions said;
};

TensorFile train(const LikenessCommand& command, const ToothFamilies& families) {
  const LabelledPanoramas panoramas =
      make_likeness_panoramas(families, load_model_crowns(command.data / "crowns" / "ssm"), command.teeth);
  command.said.tell(fmt::format("{} panoramas", panoramas.labels.size()));
  ClassifierTrainingOptions options = command.options;
  options.progress = progress_of(command.said);
  TensorFile weights = train_classifier(panoramas, options);
  weights.metadata["content"] = "A network that tells which tooth a crown is (src/completion/tooth_classifier.hpp)";
  weights.metadata["training.panoramas"] = std::to_string(panoramas.labels.size());
  weights.metadata["training.steps"] = std::to_string(options.steps);
  weights.metadata["attribution"] =
      "derived from \"Permanent Teeth\", University of Dundee School of Dentistry (E. McDougall, A. Mason, M. "
      "Roughley), CC BY 4.0, and crown models of Chen Y. et al., 2023 (MIT)";
  return weights;
}

void run(const LikenessCommand& command) {
  if (command.teeth < 1 || command.held_out < 1) throw UsageError("The numbers of teeth must be at least 1.");
  require_no_mesh_ending(command.weights, "a weight file");
  require_safe_outputs({}, {command.weights});
  require_place_for_figures(command.said, {command.data, command.weights});
  require_in_range(command.options);
  if (command.bounds_only && !std::filesystem::exists(command.weights))
    throw InputError(command.weights.string() + " is not there: bounds are found for weights.");
  prepare_for_training();
  const ToothFamilies families = load_tooth_families(command.data);
  TensorFile weights = command.bounds_only ? read_safetensors(command.weights) : train(command, families);
  const LikenessBounds bounds = draw_likeness_bounds(families, ToothClassifier(weights), command.held_out);
  note_bounds(bounds, weights);
  write_safetensors(command.weights, weights);
  command.said.tell(fmt::format("{}: bounds {:.2f}, {:.2f}, {:.2f}", command.weights.string(), bounds.other_tooth,
                                bounds.unlike, bounds.refused));
  give_figures(
      command.said,
      {{"weights", command.weights.string()},
       {"bounds", {{"other_tooth", bounds.other_tooth}, {"unlike", bounds.unlike}, {"refused", bounds.refused}}}});
}

}  // namespace

void add_likeness_command(CLI::App& app) {
  auto command = std::make_shared<LikenessCommand>();
  CLI::App* likeness_app =
      app.add_subcommand("likeness", "Train the network that tells which tooth a crown is on generated crowns");
  likeness_app->add_option("--data", command->data, "Folder with templates/, anatomy.csv and crowns/ssm/")->required();
  likeness_app->add_option("--out", command->weights, "The file of weights")->required();
  likeness_app->add_option("--teeth", command->teeth, "Generated teeth of each type to learn from")
      ->capture_default_str();
  likeness_app->add_option("--steps", command->options.steps, "Steps of the optimiser")->capture_default_str();
  likeness_app->add_option("--threads", command->options.threads, "Threads")->capture_default_str();
  likeness_app->add_option("--seed", command->options.seed, "Seed of weights, batches and variations")
      ->capture_default_str();
  likeness_app->add_option("--held-out", command->held_out, "Other teeth of each type that the bounds come from")
      ->capture_default_str();
  likeness_app->add_flag("--bounds-only", command->bounds_only,
                         "Train nothing: find the bounds of the file's weights anew");
  command->said.add_with_figures_to(*likeness_app);
  likeness_app->callback([command] { run(*command); });
}

}  // namespace rhizodont::command_line
