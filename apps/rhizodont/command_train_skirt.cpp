// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "commands.hpp"
#include "learning/blas.hpp"
#include "learning/train_surface.hpp"
#include "learning/training_sample.hpp"
#include "networks/safetensors.hpp"
#include "output_checks.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/output_files.hpp"
#include "skirt/skirt_features.hpp"
#include "training/skirt_sample.hpp"

#include <fmt/chrono.h>
#include <fmt/core.h>
#include <malloc.h>

#include <ctime>
#include <map>
#include <memory>
#include <string>

namespace rhizodont::command_line {
namespace {

struct TrainSkirtCommand {
  std::string data;
  std::string export_to;
  bool overwrite = false;
  std::string measure;
  std::string inputs = "all";
  SkirtSampleOptions samples;
  SurfaceTrainingOptions options;
};

SurfaceSample make_sample(const ToothFamilies& families, std::uint64_t seed, const TrainSkirtCommand& command) {
  const SkirtSample crown = make_skirt_sample(families, seed, command.samples);
  SurfaceSample sample = skirt_features(crown.mesh, command.options.shape.eigenvectors);
  sample.labels = crown.is_tooth;
  return sample;
}

/// The parts of the paper's comparison.
void choose_inputs(SurfaceShape& shape, const std::string& inputs) {
  shape.position = inputs != "signature";
  shape.signature = inputs != "position";
  shape.surroundings = inputs == "all";
}

void train(TrainSkirtCommand command) {
  if (const std::string warning = blas_warning(); !warning.empty()) fmt::print(stderr, "rhizodont: {}\n", warning);
  mallopt(M_MMAP_THRESHOLD, 1 << 30);  // large tensors come and go: without this, each one is new pages from the kernel
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
  const ToothFamilies families = load_tooth_families(command.data);
  const SurfaceProvider provider = [&](std::uint64_t index) { return make_sample(families, index, command); };
  if (!command.measure.empty()) {
    const SurfaceNetwork network = SurfaceNetwork::load(command.measure);
    command.options.shape.eigenvectors = network.shape().eigenvectors;
    const auto count = static_cast<std::uint64_t>(command.options.validation_samples);
    // Beyond those by which the best weights were chosen.
    const SurfaceFigures f = measure_surface(network, provider, first_validation_sample + 100'000, count);
    fmt::print("{} crowns, {} vertices: accuracy {:.4f}, intersection over union of the skirt {:.4f}\n", count,
               f.vertices, f.accuracy, f.intersection);
    return;
  }
  choose_inputs(command.options.shape, command.inputs);
  command.options.log = [](const std::string& line) {
    fmt::print("{:%F %T} {}\n", fmt::localtime(std::time(nullptr)), line);
    std::fflush(stdout);
  };
  const SurfaceTrainingResult result = train_surface(provider, command.options);
  fmt::print("{} samples; best on held-out crowns: intersection over union of the skirt {:.4f}; checkpoint in {}\n",
             result.samples, result.best.intersection, command.options.folder.string());
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
# Skirt network: which vertices of a cut crown are tooth

`{0}` holds the weights (safetensors, {1:.1f} MB). This card is written by `rhizodont train-skirt --export`.

## What it is
DiffusionNet (Sharp et al., 2022): {2} blocks of width {3}, {4} eigenvectors, spatial gradient features with rotations, one
number per vertex: the confidence that it is tooth and not skirt. Inputs: positions in the crown's frame, heat kernel
signatures, normals, distances to the border, curvatures (`src/skirt/skirt_features.hpp`).

## What it must not be used for
It says where a segmented scan shows gum, webs or ragged remains instead of tooth. It knows nothing of health: a margin
it draws is no measure of recession, decay or the cemento-enamel junction.

## Data
Crowns with skirts made on the fly by the project's generator (`src/atlas/skirt_sample.hpp`); no scan of a patient was
trained on. That spikes belong among them was seen in pictures of one coarse scan's 14 crowns; results on these were looked
at between runs, but weights and settings of the network were chosen by figures on generated crowns; how sharp a fin must be to
go (`src/skirt/spikes.hpp`) was chosen on that scan. The generator draws on "Permanent Teeth", University of Dundee School of Dentistry (E. McDougall, A. Mason,
M. Roughley), CC BY 4.0, and on the statistical crown models of Chen Y. et al., "Automatic 3D Teeth Reconstruction from
Five Intra-oral Photos Using Parametric Teeth Model", 2023 (MIT). The weights are derived from these: keep the attribution.

## Training
`rhizodont train-skirt --data DATA --out FOLDER --samples N --pool {8} --seed {5}`: {6} samples in {7} steps from a pool of {8} crowns; settings in
`src/learning/train_surface.hpp`, exported on {9}.

## Figures
On {10} generated crowns that were never trained on (by which the best weights were chosen), threshold 0.5, before the
border is cleaned:

| figure | value |
|---|---|
| accuracy over vertices | {11} |
| intersection over union of the skirt | {12} |
)",
      weights.path.filename().string(), static_cast<double>(weights.bytes.size()) * 1e-6, note("shape.blocks"),
      note("shape.width"), note("shape.eigenvectors"), note("training.seed"), note("training.samples"),
      note("training.steps"), note("training.pool"), note("training.date"), note("validation.samples"),
      note("validation.accuracy"), note("validation.intersection_over_union"));
}

void export_weights(const TrainSkirtCommand& command) {
  const std::filesystem::path path = command.export_to;
  const std::filesystem::path card = require_safe_export(path, command.options.folder, command.overwrite);
  const TensorFile exported = export_surface(
      command.options.folder,
      {{"training.date", fmt::format("{:%F}", fmt::localtime(std::time(nullptr)))},
       {"licence", "weights derived from \"Permanent Teeth\", University of Dundee School of Dentistry, CC BY 4.0"},
       {"use", "not for diagnosis"}});
  const auto& notes = exported.metadata;
  const OutputFile weights{path, safetensors_bytes(exported)};
  write_output_files({weights, {card, model_card(weights, notes)}});
  fmt::print("{}: {} samples trained\n", path.string(), notes.at("training.samples"));
}

void add_training_options(CLI::App& app, SurfaceTrainingOptions& o) {
  app.add_option("--samples", o.samples, "Samples in all; the learning rate falls until there")->capture_default_str();
  app.add_option("--pool", o.pool, "Different crowns; afterwards they come again, turned otherwise")
      ->capture_default_str();
  app.add_option("--hours", o.hours, "Stop after this time (0: no limit)")->capture_default_str();
  app.add_option("--batch", o.batch, "Samples per step")->capture_default_str();
  app.add_option("--rate", o.learning_rate, "Largest learning rate")->capture_default_str();
  app.add_option("--width", o.shape.width, "Channels of the network")->capture_default_str();
  app.add_option("--blocks", o.shape.blocks, "Blocks of the network")->capture_default_str();
  app.add_option("--eigenvectors", o.shape.eigenvectors, "Eigenvectors of the surface")->capture_default_str();
  app.add_option("--threads", o.threads, "Threads; the batch is a multiple of them")->capture_default_str();
  app.add_option("--seed", o.seed, "Seed of weights and turns")->capture_default_str();
  app.add_option("--held-out", o.validation_samples, "Generated crowns to validate on, or to measure")
      ->capture_default_str();
  app.add_option("--validation-minutes", o.validation_minutes, "Time between validations")->capture_default_str();
}

}  // namespace

void add_train_skirt_command(CLI::App& app) {
  auto command = std::make_shared<TrainSkirtCommand>();
  CLI::App* train_app = app.add_subcommand("train-skirt", "Train the network that finds skirts on generated crowns");
  auto* data = train_app->add_option("--data", command->data, "Folder with templates/, anatomy.csv and crowns/ssm/");
  train_app->add_option("--out", command->options.folder, "Folder of checkpoints and best weights");
  train_app->add_flag("--resume", command->options.resume, "Go on from the folder's checkpoint");
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
  train_app->callback([command, data, export_to] {
    if (command->measure.empty() && command->options.folder.empty())
      throw UsageError("Training needs a folder for its checkpoints (--out).");
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
