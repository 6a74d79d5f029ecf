// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "command_line/output_options.hpp"
#include "commands.hpp"
#include "learning/train_completion.hpp"
#include "rhizodont/error.hpp"
#include "training/completion_sample.hpp"
#include "training/model_card.hpp"
#include "training_output.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <memory>
#include <string>

namespace rhizodont::command_line {
namespace {

struct CompletionCommand {
  std::string data;
  std::string population, registered;
  std::string export_to;
  bool overwrite = false;
  CompletionSampleOptions samples;
  CompletionTrainingOptions options;
  OutputOptions said;
};

void train(const CompletionCommand& command) {
  require_place_for_figures(command.said,
                            {command.data, command.population, command.registered, command.options.loop.start_from});
  prepare_for_training();
  FamilyLoadOptions population;
  population.population = command.population;
  population.registered = command.registered;
  const ToothFamilies families = load_tooth_families(command.data, population);
  CompletionTrainingOptions options = command.options;
  options.loop.progress = progress_of(command.said);
  const CompletionTrainingResult result = train_completion(
      [&](std::uint64_t index) { return make_completion_sample(families, index, command.samples).pair; }, options);
  command.said.tell(fmt::format("{} samples, best root Chamfer distance on held-out teeth {:.3f} mm; checkpoint in {}",
                                result.samples, result.best_root_chamfer, options.loop.folder.string()));
  give_figures(command.said, {{"samples", result.samples},
                              {"best_root_chamfer_mm", result.best_root_chamfer},
                              {"folder", options.loop.folder.string()}});
}

/// The network's size; the rest of its shape follows or stays as it is.
void add_shape_options(CLI::App& train_app, CompletionShape& shape) {
  constexpr int head_width = 64;
  train_app
      .add_option_function<int>(
          "--width",
          [&shape](int width) {
            shape.width = width;
            shape.heads = std::max(1, width / head_width);
            shape.global_width = 2 * width;
          },
          "Channels of a token, a multiple of 64")
      ->default_str(std::to_string(shape.width));
  train_app
      .add_option_function<int>(
          "--blocks", [&shape](int blocks) { shape.encoder_depth = shape.decoder_depth = blocks; },
          "Blocks of encoder and decoder each")
      ->default_str(std::to_string(shape.encoder_depth));
  train_app.add_option("--queries", shape.queries, "Patches of the output")->capture_default_str();
  train_app.add_option("--patch-points", shape.patch_points, "Points of a patch")->capture_default_str();
}

}  // namespace

void add_completion_command(CLI::App& app) {
  auto command = std::make_shared<CompletionCommand>();
  TrainingLoopOptions& o = command->options.loop;
  CLI::App* train_app = app.add_subcommand("completion", "Train the completion network on generated teeth");
  auto* data = train_app->add_option("--data", command->data, "Folder with templates/, anatomy.csv and crowns/ssm/");
  train_app->add_option(
      "--population", command->population,
      "JSON table of lengths, roots and curves by tooth; without it the middle of published populations");
  train_app->add_option("--registered", command->registered,
                        "Folder of registered teeth (rhizodont register): each is a further template of its type");
  train_app->add_option("--out", o.folder, "Folder of checkpoints and best weights")->required();
  train_app->add_flag("--resume", o.resume, "Go on from the folder's checkpoint");
  train_app->add_option("--start-from", o.start_from,
                        "Weights to begin with, made on other families; without it the run begins at random");
  train_app->add_option("--samples", o.samples, "Samples in all; the learning rate falls until there")
      ->capture_default_str();
  train_app->add_option("--hours", o.hours, "Stop after this time (0: no limit)")->capture_default_str();
  train_app->add_option("--batch", o.batch, "Samples per step")->capture_default_str();
  train_app->add_option("--rate", o.learning_rate, "Largest learning rate")->capture_default_str();
  train_app->add_option("--threads", o.threads, "Threads; the batch is a multiple of them")->capture_default_str();
  train_app->add_option("--seed", o.seed, "Seed of weights and noise")->capture_default_str();
  add_shape_options(*train_app, command->options.shape);
  train_app->add_option("--processes", o.processes.count, "Processes that train together, on one machine or several")
      ->capture_default_str();
  train_app->add_option("--rank", o.processes.rank, "Number of this process, from 0; 0 keeps log and checkpoints")
      ->capture_default_str();
  train_app->add_option("--first", o.processes.first_address, "HOST:PORT where process 0 listens")
      ->capture_default_str();
  auto* export_to = train_app->add_option(
      "--export", command->export_to, "Train nothing: write the folder's best weights and a model card to this file");
  train_app->add_flag("--overwrite", command->overwrite, "The export may replace an older model card");
  command->said.add_with_figures_to(*train_app);
  train_app->callback([command, data, export_to] {
    if (*export_to) {
      export_weights({command->options.loop.folder, command->export_to, command->overwrite, export_completion,
                      completion_card, command->said});
    } else if (*data) {
      train(*command);
    } else {
      throw UsageError("Training needs the folder with templates (--data).");
    }
  });
}

}  // namespace rhizodont::command_line
