// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "commands.hpp"
#include "families/completion_sample.hpp"
#include "learning/blas.hpp"
#include "learning/train_completion.hpp"
#include "networks/safetensors.hpp"
#include "output_checks.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/output_files.hpp"

#include <fmt/chrono.h>
#include <fmt/core.h>
#include <malloc.h>

#include <algorithm>
#include <ctime>
#include <memory>
#include <string>

namespace rhizodont::command_line {
namespace {

struct TrainCommand {
  std::string data;
  std::string export_to;
  bool overwrite = false;
  CompletionSampleOptions samples;
  TrainingOptions options;
};

std::vector<Eigen::Vector3f> to_points(const std::vector<float>& xyz) {
  std::vector<Eigen::Vector3f> points;
  points.reserve(xyz.size() / 3);
  for (std::size_t i = 0; i + 2 < xyz.size(); i += 3) points.emplace_back(xyz[i], xyz[i + 1], xyz[i + 2]);
  return points;
}

TrainingSample make_sample(const ToothFamilies& families, std::uint64_t seed, const CompletionSampleOptions& options) {
  const CompletionSample sample = make_completion_sample(families, seed, options);
  TrainingSample result;
  result.input = to_points(sample.input);
  result.target = to_points(sample.target);
  result.normals = to_points(sample.target_normals);
  result.is_root = sample.target_root;
  result.type = sample.type;
  result.form_axis = sample.form_axis.cast<float>();
  result.matched = to_points(sample.matched);
  result.matched_normals = to_points(sample.matched_normals);
  result.matched_root = sample.matched_root;
  return result;
}

void train(const TrainCommand& command) {
  static_assert(first_validation_sample == validation_seed_offset);
  if (const std::string warning = blas_warning(); !warning.empty()) fmt::print(stderr, "rhizodont: {}\n", warning);
  // Tensors of some megabytes come and go all the time: without this, each one is new pages from the kernel.
  mallopt(M_MMAP_THRESHOLD, 1 << 30);
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
  const ToothFamilies families = load_tooth_families(command.data);
  TrainingOptions options = command.options;
  options.log = [](const std::string& line) {
    fmt::print("{:%F %T} {}\n", fmt::localtime(std::time(nullptr)), line);
    std::fflush(stdout);
  };
  const TrainingResult result =
      train_completion([&](std::uint64_t index) { return make_sample(families, index, command.samples); }, options);
  fmt::print("{} samples, best root Chamfer distance on held-out teeth {:.3f} mm; checkpoint in {}\n", result.samples,
             result.best_root_chamfer, options.folder.string());
}

/// What the weights are, where they come from and what they must not be used for, beside the weight file.
std::string model_card(const OutputFile& weights, const std::map<std::string, std::string>& notes) {
  const auto note = [&](const std::string& key) {
    const auto found = notes.find(key);
    return found == notes.end() ? std::string("not measured") : found->second;
  };
  return fmt::format(
      R"(<!--
SPDX-FileCopyrightText: Rhizodont contributors
SPDX-License-Identifier: GPL-3.0-or-later
-->
# Completion network: crown points in, whole-tooth points out

`{0}` holds the weights (safetensors, half precision, {1:.1f} MB). This card is written by `rhizodont train --export`.

## What it is
AdaPoinTr (Yu et al., 2023) with learned starting points per tooth type; in go {2} crown points and how far the crown's
form leans against its border, out come {3} points with normals, in the canonical pose (unit 12 mm). How it differs from the published network: `src/learning/adapointr.hpp`.

## What it must not be used for
Its roots are a guess from the crown alone: typical for a tooth of that type and size, not the patient's anatomy. They
must not be used for diagnosis, for surgery or implant planning, or to judge root length, resorption or the distance to
nerves and neighbouring roots. A root's length follows from its crown only weakly.

## Data
Teeth made on the fly by the project's generator (`src/atlas`): 16 permanent types, the right side mirrored to the left.
The generator draws on these sources, and training on nothing else:
- "Permanent Teeth", University of Dundee School of Dentistry (E. McDougall, A. Mason, M. Roughley), CC BY 4.0: 16
  complete template teeth, scaled, bent and warped by the generator;
- the statistical crown models (mean and modes of about 95 people's crowns, 28 tooth numbers) of Chen Y. et al.,
  "Automatic 3D Teeth Reconstruction from Five Intra-oral Photos Using Parametric Teeth Model", 2023 (MIT), which give
  the generated crowns their forms;
- mean tooth dimensions after Wheeler and Ash and Nelson (facts); crowns are 2 % larger than these, a rough reading of
  the crown models.

No single scan of a patient was trained on. Settings of the generator that were chosen after the 14 validation teeth had been seen:
the crowns' size above; that nearly half of the crops lie across the whole tooth's long axis, as the paper's do, after the
validation crowns had turned out to be cut like that (within 1.5 degrees: such a cut tells where the root goes, and a gum
line tells less); that a type keeps but 0.4 of its one template's lean of the
root, after predictions had leaned away from the validation roots (the share itself rests on how far the 16 templates
differ); and that molars part where published measurements say, looked up after furcations had come out 2 mm too low on
them. To that extent figures on those teeth are not blind. No weight was trained or selected on them.

The weights are derived from these templates and crown models: keep the attribution when you pass them on.

## Training
`rhizodont train --data DATA --out FOLDER --seed {4}`, {5} samples in {6} steps; settings in
`src/learning/train_completion.hpp`, exported on {7}.

## Figures
On {8} generated teeth that were never trained on (running mean of the weights):

| figure | value |
|---|---|
| Chamfer-L1, whole tooth | {9} mm |
| Chamfer-L1, part below the crop | {10} mm |
| depth of the tooth's lowest point, mean absolute error | {11} mm |
| normals, mean error | {12} degrees |

Figures on real teeth: `rhizodont evaluate`.
)",
      weights.path.filename().string(), static_cast<double>(weights.bytes.size()) * 1e-6, note("shape.input_points"),
      std::stoi(note("shape.queries")) * std::stoi(note("shape.patch_points")), note("training.seed"),
      note("training.samples"), note("training.steps"), note("training.date"), note("validation.samples"),
      note("validation.tooth_chamfer_l1_mm"), note("validation.root_chamfer_l1_mm"), note("validation.depth_error_mm"),
      note("validation.normal_error_degrees"));
}

void export_weights(const TrainCommand& command) {
  const std::filesystem::path path = command.export_to;
  const std::filesystem::path card = require_safe_export(path, command.options.folder, command.overwrite);
  const TensorFile exported = export_completion(
      command.options.folder,
      {{"training.date", fmt::format("{:%F}", fmt::localtime(std::time(nullptr)))},
       {"licence", "weights derived from \"Permanent Teeth\", University of Dundee School of Dentistry, CC BY 4.0"},
       {"use", "not for diagnosis"}});
  const auto& notes = exported.metadata;
  const OutputFile weights{path, safetensors_bytes(exported)};
  write_output_files({weights, {card, model_card(weights, notes)}});
  fmt::print("{}: {} samples trained\n", path.string(), notes.at("training.samples"));
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

void add_train_command(CLI::App& app) {
  auto command = std::make_shared<TrainCommand>();
  TrainingOptions& o = command->options;
  CLI::App* train_app = app.add_subcommand("train", "Train the completion network on generated teeth");
  auto* data = train_app->add_option("--data", command->data, "Folder with templates/, anatomy.csv and crowns/ssm/");
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
  add_shape_options(*train_app, o.shape);
  train_app->add_option("--processes", o.processes.count, "Processes that train together, on one machine or several")
      ->capture_default_str();
  train_app->add_option("--rank", o.processes.rank, "Number of this process, from 0; 0 keeps log and checkpoints")
      ->capture_default_str();
  train_app->add_option("--first", o.processes.first_address, "HOST:PORT where process 0 listens")
      ->capture_default_str();
  auto* export_to = train_app->add_option(
      "--export", command->export_to, "Train nothing: write the folder's best weights and a model card to this file");
  train_app->add_flag("--overwrite", command->overwrite, "The export may replace an older model card");
  train_app->callback([command, data, export_to] {
    if (*export_to) {
      export_weights(*command);
    } else if (*data) {
      train(*command);
    } else {
      throw UsageError("Training needs the folder with templates (--data).");
    }
  });
}

}  // namespace rhizodont::command_line
