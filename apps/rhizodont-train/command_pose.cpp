// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "command_line/output_checks.hpp"
#include "command_line/output_options.hpp"
#include "commands.hpp"
#include "learning/train_pose.hpp"
#include "networks/safetensors.hpp"
#include "rhizodont/error.hpp"
#include "training/pose_samples.hpp"
#include "training_output.hpp"

#include <fmt/core.h>

#include <filesystem>
#include <memory>
#include <string>

namespace rhizodont::command_line {
namespace {

struct PoseCommand {
  std::filesystem::path data, weights;
  int teeth = 400;
  int held_out = 40;
  PoseTrainingOptions options;
  OutputOptions said;
};

void run(const PoseCommand& command) {
  if (command.teeth < 1 || command.held_out < 1) throw UsageError("The numbers of teeth must be at least 1.");
  require_no_mesh_ending(command.weights, "a weight file");
  require_safe_outputs({}, {command.weights});
  require_place_for_figures(command.said, {command.data, command.weights});
  require_in_range(command.options);
  prepare_for_training();
  const ToothFamilies families = load_tooth_families(command.data);
  const PosedPanoramas panoramas = make_posed_panoramas(families, command.teeth);
  command.said.tell(fmt::format("{} panoramas", panoramas.azimuths.size()));
  PoseTrainingOptions options = command.options;
  options.progress = progress_of(command.said);
  TensorFile weights = train_pose(panoramas, options);
  const PoseErrors errors = pose_errors(families, PoseNetwork(weights), command.held_out);
  weights.metadata["content"] = "A network that tells how a crown stands (models/pose.md)";
  weights.metadata["training.panoramas"] = std::to_string(panoramas.azimuths.size());
  weights.metadata["training.steps"] = std::to_string(options.steps);
  weights.metadata["attribution"] =
      "derived from \"Permanent Teeth\", University of Dundee School of Dentistry (E. McDougall, A. Mason, M. "
      "Roughley), CC BY 4.0, and crown models of Chen Y. et al., 2023 (MIT)";
  write_safetensors(command.weights, weights);
  command.said.tell(
      fmt::format("{}: of {} other crowns the turn is lost of {:.1f} %, off by {:.1f} degrees else; leans are off by "
                  "{:.1f} degrees",
                  command.weights.string(), errors.crowns, 100 * errors.lost, errors.turn, errors.lean));
  give_figures(command.said, {{"weights", command.weights.string()},
                              {"crowns", errors.crowns},
                              {"lost_share", errors.lost},
                              {"turn_degrees", errors.turn},
                              {"lean_degrees", errors.lean}});
}

}  // namespace

void add_pose_command(CLI::App& app) {
  auto command = std::make_shared<PoseCommand>();
  CLI::App* pose =
      app.add_subcommand("pose", "Train the network that tells how a crown is turned and leans on generated crowns");
  pose->add_option("--data", command->data, "Folder with templates/, anatomy.csv and crowns/ssm/")->required();
  pose->add_option("--out", command->weights, "The file of weights")->required();
  pose->add_option("--teeth", command->teeth, "Generated teeth of each type to learn from")->capture_default_str();
  pose->add_option("--steps", command->options.steps, "Steps of the optimiser")->capture_default_str();
  pose->add_option("--threads", command->options.threads, "Threads")->capture_default_str();
  pose->add_option("--seed", command->options.seed, "Seed of weights, batches and variations")->capture_default_str();
  pose->add_option("--held-out", command->held_out, "Other teeth of each type that the figures come from")
      ->capture_default_str();
  command->said.add_with_figures_to(*pose);
  pose->callback([command] { run(*command); });
}

}  // namespace rhizodont::command_line
