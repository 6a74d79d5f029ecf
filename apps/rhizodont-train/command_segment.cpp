// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "command_line/output_options.hpp"
#include "commands.hpp"
#include "learning/train_scan.hpp"
#include "rhizodont/error.hpp"
#include "training/arch_cloud.hpp"
#include "training/model_card.hpp"
#include "training_output.hpp"

#include <fmt/core.h>

#include <memory>
#include <string>

namespace rhizodont::command_line {
namespace {

struct SegmentCommand {
  std::string data, cache;
  std::string export_to;
  bool overwrite = false;
  std::uint64_t make = 0, first = 0;
  bool make_held_out = false;
  ArchDrawOptions draw;
  ScanTrainingOptions options;
  OutputOptions said;
};

/// Scans are made ahead of the training, by as many processes as there is room for.
void make_samples(const SegmentCommand& command) {
  require_place_for_figures(command.said, {command.data});
  const ArchFamily family = load_arch_family(command.data);
  nlohmann::ordered_json scans = nlohmann::ordered_json::array();
  for (std::uint64_t i = command.first; i < command.first + command.make; ++i) {
    const std::uint64_t seed = i + (command.make_held_out ? first_validation_sample : 0);
    try {
      const LabelledCloud scan = kept_arch_cloud(family, seed, command.cache, command.draw);
      command.said.tell(fmt::format("{}: {} points", seed, scan.cloud.size()));
      scans.push_back({{"seed", seed}, {"points", scan.cloud.size()}});
    } catch (const NoResultError& error) {
      command.said.tell(fmt::format("{}: {}", seed, error.what()));
      scans.push_back({{"seed", seed}, {"refusal", error.what()}});
    }
    std::fflush(stdout);
  }
  give_figures(command.said, {{"scans", scans}});
}

/// A draw that gives no scan is replaced by the next one that does.
LabelledCloud any_cloud(const ArchFamily& family, std::uint64_t seed, const std::string& cache) {
  constexpr std::uint64_t aside = std::uint64_t{1} << 20;
  for (std::uint64_t attempt = 0;; ++attempt) try {
      const std::uint64_t drawn = seed + attempt * aside;
      return cache.empty() ? make_arch_cloud(family, drawn) : kept_arch_cloud(family, drawn, cache);
    } catch (const NoResultError&) {
      if (attempt == 3) throw;
    }
}

void train(SegmentCommand command) {
  require_place_for_figures(command.said, {command.data});
  prepare_for_training();
  const ArchFamily family = load_arch_family(command.data);
  const CloudProvider provider = [&](std::uint64_t index) { return any_cloud(family, index, command.cache); };
  command.options.loop.progress = progress_of(command.said);
  const ScanTrainingResult result = train_scan(provider, command.options);
  command.said.tell(fmt::format("{} samples; best on held-out scans: {:.4f} of points right; checkpoint in {}",
                                result.samples, result.best.accuracy, command.options.loop.folder.string()));
  give_figures(command.said, {{"samples", result.samples},
                              {"best_accuracy", result.best.accuracy},
                              {"folder", command.options.loop.folder.string()}});
}

void add_training_options(CLI::App& app, ScanTrainingOptions& options) {
  TrainingLoopOptions& o = options.loop;
  app.add_option("--samples", o.samples, "Samples in all; the learning rate falls until there")->capture_default_str();
  app.add_option("--pool", options.pool, "Different scans; afterwards they come again, varied otherwise")
      ->capture_default_str();
  app.add_option("--hours", o.hours, "Stop after this time (0: no limit)")->capture_default_str();
  app.add_option("--batch", o.batch, "Samples per step")->capture_default_str();
  app.add_option("--rate", o.learning_rate, "Largest learning rate")->capture_default_str();
  app.add_option("--threads", o.threads, "Threads; the batch is a multiple of them")->capture_default_str();
  app.add_option("--seed", o.seed, "Seed of weights and variations")->capture_default_str();
  app.add_option("--held-out", o.validation_samples, "Generated scans to validate on")->capture_default_str();
  app.add_option("--validation-minutes", o.validation_minutes, "Time between validations")->capture_default_str();
  app.add_option("--start-from", o.start_from, "Weights to begin with");
}

}  // namespace

void add_segment_command(CLI::App& app) {
  auto command = std::make_shared<SegmentCommand>();
  CLI::App* train_app = app.add_subcommand("segment", "Train the network that finds teeth on generated scans");
  auto* data = train_app->add_option("--data", command->data, "Folder with crowns/");
  train_app->add_option("--cache", command->cache, "Folder where generated scans are kept");
  train_app->add_option("--out", command->options.loop.folder, "Folder of checkpoints and best weights");
  train_app->add_flag("--resume", command->options.loop.resume, "Go on from the folder's checkpoint");
  add_training_options(*train_app, command->options);
  train_app->add_option("--make", command->make, "Train nothing: put so many scans into the cache");
  train_app->add_option("--first", command->first, "Number of the first one to make")->capture_default_str();
  train_app->add_option("--milk-share", command->draw.milk_share, "Of those made: the share with milk teeth, 0 to 1")
      ->capture_default_str();
  train_app->add_flag("--make-held-out", command->make_held_out, "Make those that validation takes");
  auto* export_to = train_app->add_option(
      "--export", command->export_to, "Train nothing: write the folder's best weights and a model card to this file");
  train_app->add_flag("--overwrite", command->overwrite, "The export may replace an older model card");
  command->said.add_with_figures_to(*train_app);
  train_app->callback([command, data, export_to] {
    if (*export_to) {
      if (command->options.loop.folder.empty()) throw UsageError("An export needs the training's folder (--out).");
      export_weights({command->options.loop.folder, command->export_to, command->overwrite, export_scan, segment_card,
                      command->said});
      return;
    }
    if (!*data) throw UsageError("Training needs the folder with crowns (--data).");
    if (command->make > 0) {
      if (command->cache.empty()) throw UsageError("Scans are made for a folder (--cache).");
      make_samples(*command);
      return;
    }
    if (command->options.loop.folder.empty()) throw UsageError("Training needs a folder for its checkpoints (--out).");
    train(*command);
  });
}

}  // namespace rhizodont::command_line
