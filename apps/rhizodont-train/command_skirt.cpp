// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "command_line/output_options.hpp"
#include "commands.hpp"
#include "learning/train_surface.hpp"
#include "rhizodont/error.hpp"
#include "training/model_card.hpp"
#include "training/skirt_sample.hpp"
#include "training_output.hpp"

#include <fmt/core.h>

#include <memory>
#include <string>

namespace rhizodont::command_line {
namespace {

struct SkirtCommand {
  std::string data;
  std::string export_to;
  bool overwrite = false;
  std::string measure;
  std::string inputs = "all";
  SkirtSampleOptions samples;
  SurfaceTrainingOptions options;
  OutputOptions said;
};

/// The parts of the paper's comparison.
void choose_inputs(SurfaceShape& shape, const std::string& inputs) {
  shape.position = inputs != "signature";
  shape.signature = inputs != "position";
  shape.surroundings = inputs == "all";
}

void train(SkirtCommand command) {
  require_place_for_figures(command.said, {command.data, command.measure});
  prepare_for_training();
  const ToothFamilies families = load_tooth_families(command.data);
  const SurfaceProvider provider = [&](std::uint64_t index) {
    return make_skirt_training_sample(families, index, command.samples, command.options.shape.eigenvectors);
  };
  if (!command.measure.empty()) {
    const SurfaceNetwork network = SurfaceNetwork::load(command.measure);
    command.options.shape.eigenvectors = network.shape().eigenvectors;
    const auto count = static_cast<std::uint64_t>(command.options.loop.validation_samples);
    // Beyond those by which the best weights were chosen.
    const SurfaceFigures f = measure_surface(network, provider, first_validation_sample + 100'000, count);
    command.said.tell(
        fmt::format("{} crowns, {} vertices: accuracy {:.4f}, intersection over union of the skirt {:.4f}", count,
                    f.vertices, f.accuracy, f.intersection));
    give_figures(command.said, {{"crowns", count},
                                {"vertices", f.vertices},
                                {"accuracy", f.accuracy},
                                {"intersection_over_union", f.intersection}});
    return;
  }
  choose_inputs(command.options.shape, command.inputs);
  command.options.loop.progress = progress_of(command.said);
  const SurfaceTrainingResult result = train_surface(provider, command.options);
  command.said.tell(
      fmt::format("{} samples; best on held-out crowns: intersection over union of the skirt {:.4f}; checkpoint in {}",
                  result.samples, result.best.intersection, command.options.loop.folder.string()));
  give_figures(command.said, {{"samples", result.samples},
                              {"best_intersection_over_union", result.best.intersection},
                              {"folder", command.options.loop.folder.string()}});
}

void add_training_options(CLI::App& app, SurfaceTrainingOptions& options) {
  TrainingLoopOptions& o = options.loop;
  app.add_option("--samples", o.samples, "Samples in all; the learning rate falls until there")->capture_default_str();
  app.add_option("--pool", options.pool, "Different crowns; afterwards they come again, turned otherwise")
      ->capture_default_str();
  app.add_option("--hours", o.hours, "Stop after this time (0: no limit)")->capture_default_str();
  app.add_option("--batch", o.batch, "Samples per step")->capture_default_str();
  app.add_option("--rate", o.learning_rate, "Largest learning rate")->capture_default_str();
  app.add_option("--width", options.shape.width, "Channels of the network")->capture_default_str();
  app.add_option("--blocks", options.shape.blocks, "Blocks of the network")->capture_default_str();
  app.add_option("--eigenvectors", options.shape.eigenvectors, "Eigenvectors of the surface")->capture_default_str();
  app.add_option("--threads", o.threads, "Threads; the batch is a multiple of them")->capture_default_str();
  app.add_option("--seed", o.seed, "Seed of weights and turns")->capture_default_str();
  app.add_option("--held-out", o.validation_samples, "Generated crowns to validate on, or to measure")
      ->capture_default_str();
  app.add_option("--validation-minutes", o.validation_minutes, "Time between validations")->capture_default_str();
}

}  // namespace

void add_skirt_command(CLI::App& app) {
  auto command = std::make_shared<SkirtCommand>();
  CLI::App* train_app = app.add_subcommand("skirt", "Train the network that finds skirts on generated crowns");
  auto* data = train_app->add_option("--data", command->data, "Folder with templates/, anatomy.csv and crowns/ssm/");
  train_app->add_option("--out", command->options.loop.folder, "Folder of checkpoints and best weights");
  train_app->add_flag("--resume", command->options.loop.resume, "Go on from the folder's checkpoint");
  add_training_options(*train_app, command->options);
  train_app
      ->add_option("--inputs", command->inputs, "What the network looks at: all, position, signature, both of these")
      ->check(CLI::IsMember({"all", "position", "signature", "both"}))
      ->capture_default_str();
  train_app->add_option("--finest-edge", command->samples.finest_edge_mm, "Shortest edges of the scans, mm")
      ->capture_default_str();
  train_app->add_option("--coarsest-edge", command->samples.coarsest_edge_mm, "Longest edges of the scans, mm")
      ->capture_default_str();
  train_app->add_option("--measure", command->measure, "Train nothing: measure these weights on new held-out crowns");
  auto* export_to = train_app->add_option(
      "--export", command->export_to, "Train nothing: write the folder's best weights and a model card to this file");
  train_app->add_flag("--overwrite", command->overwrite, "The export may replace an older model card");
  command->said.add_with_figures_to(*train_app);
  train_app->callback([command, data, export_to] {
    if (command->measure.empty() && command->options.loop.folder.empty())
      throw UsageError("Training needs a folder for its checkpoints (--out).");
    if (*export_to) {
      export_weights({command->options.loop.folder, command->export_to, command->overwrite, export_surface, skirt_card,
                      command->said});
    } else if (*data) {
      train(*command);
    } else {
      throw UsageError("Training needs the folder with templates (--data).");
    }
  });
}

}  // namespace rhizodont::command_line
