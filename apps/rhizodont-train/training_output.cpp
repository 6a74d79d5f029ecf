// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "training_output.hpp"

#include "base/loaded_blas.hpp"
#include "command_line/output_checks.hpp"
#include "command_line/terminal.hpp"
#include "rhizodont/output_files.hpp"

#include <fmt/chrono.h>
#include <fmt/core.h>
#include <malloc.h>

#include <algorithm>
#include <ctime>
#include <string>

namespace rhizodont::command_line {
namespace {

std::string figures_text(const std::map<std::string, double>& figures, const char* between) {
  std::string text;
  for (const auto& [name, value] : figures) {
    std::string words = name;
    std::replace(words.begin(), words.end(), '_', ' ');
    text += fmt::format("{}{} {:.4f}", text.empty() ? "" : between, words, value);
  }
  return text;
}

/// A report as a line of text, without time and line break.
std::string progress_text(const TrainingProgress& p) {
  switch (p.event) {
    case TrainingEvent::resumed:
      return fmt::format("going on from {} samples", p.samples);
    case TrainingEvent::steps:
      return fmt::format("step {} samples {} loss {:.4f} {}{}gradient {:.2f} rate {:.2e} {:.1f} samples/s", p.steps,
                         p.samples, p.loss, figures_text(p.terms, " "), p.terms.empty() ? "" : " ", p.gradient_norm,
                         p.learning_rate, p.samples_per_second);
    case TrainingEvent::validation:
      break;
  }
  return fmt::format("validation at {} samples: {}{}", p.samples, figures_text(p.validation, ", "),
                     p.is_best ? ", best so far" : "");
}

}  // namespace

void prepare_for_training() {
  if (const std::string warning = blas_warning(); !warning.empty()) print_error("rhizodont-train", warning);
  // Tensors of some megabytes come and go all the time: without this, each one is new pages from the kernel.
  mallopt(M_MMAP_THRESHOLD, 1 << 30);
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
}

std::function<void(const TrainingProgress&)> progress_of(const OutputOptions& said) {
  return [said](const TrainingProgress& progress) {
    said.tell(fmt::format("{:%F %T} {}", fmt::localtime(std::time(nullptr)), progress_text(progress)));
    std::fflush(stdout);
  };
}

void require_place_for_figures(const OutputOptions& said, const std::vector<std::filesystem::path>& inputs) {
  const std::vector<std::filesystem::path> outputs = said.outputs();
  if (outputs.empty()) return;
  std::vector<std::filesystem::path> files;
  for (const std::filesystem::path& input : inputs) {
    if (!input.empty()) files.push_back(input);
    for (const std::filesystem::path& file : files_below(input)) files.push_back(file);
  }
  require_safe_outputs(files, outputs);
}

void give_figures(const OutputOptions& said, const nlohmann::ordered_json& figures) {
  write_output_files(said.print_or_file(figures));
}

void export_weights(const WeightExport& what) {
  require_place_for_figures(what.said);
  const std::filesystem::path card = require_safe_export(what.weights, what.folder, what.overwrite);
  const TensorFile exported = what.read(
      what.folder,
      {{"training.date", fmt::format("{:%F}", fmt::localtime(std::time(nullptr)))},
       {"licence", "weights derived from \"Permanent Teeth\", University of Dundee School of Dentistry, CC BY 4.0"},
       {"use", "not for diagnosis"}});
  const OutputFile weights{what.weights, safetensors_bytes(exported)};
  const WeightFile described{what.weights.filename().string(), weights.bytes.size(), exported.metadata};
  write_output_files({weights, {card, what.card(described)}});
  const std::string& samples = exported.metadata.at("training.samples");
  what.said.tell(fmt::format("{}: {} samples trained", what.weights.string(), samples));
  give_figures(what.said, {{"weights", what.weights.string()}, {"samples", std::stoll(samples)}});
}

}  // namespace rhizodont::command_line
