// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "commands.hpp"
#include "learning/blas.hpp"
#include "rhizodont/complete.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/io.hpp"
#include "rhizodont/tooth_file.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace rhizodont::command_line {
namespace {

struct CompleteCommand {
  std::string crown;
  std::string output;
  std::string report;
  std::string models;
  std::string skirt = "keep";
  std::string confidence;
  int fdi = 0;
  int candidates = 1;
  bool quiet = false;
  CompleteOptions options;
};

const std::map<std::string, CapHandling> cap_names{{"drop", CapHandling::drop}, {"keep", CapHandling::keep}};
const std::map<std::string, double> unit_names{{"mm", 1}, {"cm", 10}, {"in", 25.4}, {"m", 1000}};

/// One line that names the stage at work, on a terminal only.
ProgressCallback progress_line(bool quiet) {
  if (quiet || !isatty(STDERR_FILENO)) return {};
  return [](std::string_view stage) {
    fmt::print(stderr, "\r\033[K{} ...", stage);
    std::fflush(stderr);
  };
}

void clear_line(const ProgressCallback& progress) {
  if (progress) fmt::print(stderr, "\r\033[K");
}

/// The files of a candidate: the first has the names that the user gave, the others a number before the extension.
std::filesystem::path numbered(const std::filesystem::path& file, std::size_t candidate) {
  if (candidate == 0) return file;
  std::filesystem::path result = file;
  return result.replace_filename(
      fmt::format("{}_{}{}", file.stem().string(), candidate + 1, file.extension().string()));
}

void print_summary(const CompletedTooth& tooth, const std::string& output) {
  const CompletionRecord& r = tooth.record;
  double seconds = 0;
  for (const StageRecord& stage : r.stages) seconds += stage.seconds;
  fmt::print(
      "{}: tooth {}{}, {} of {} crown triangles kept bit for bit, root {:.1f} mm, new triangles Q {:.3f}, {:.2f} s\n",
      output, r.fdi, r.fdi_guessed ? " (guessed)" : "", r.kept_triangles, r.crown_triangles, r.root_length_mm,
      r.promises.new_triangles.all.value_or(QualityFigures{}).q_avg, seconds);
  if (const auto& interval = r.root_interval)
    fmt::print("  root length with 80 % probability {:.1f} to {:.1f} mm, apex within {:.1f} mm\n",
               interval->length_low_mm, interval->length_high_mm, interval->apex_radius_mm);
  const auto skirt = std::count_if(r.dropped_vertices.begin(), r.dropped_vertices.end(),
                                   [](const DroppedCrownVertex& d) { return d.reason == "skirt"; });
  if (skirt > 0) fmt::print("  {} vertices dropped as skirt\n", skirt);
  for (const RepairStep& step : r.repairs)
    fmt::print("  repaired: {} ({} vertices, {} triangles)\n", step.action, step.vertices.size(),
               step.triangles.size());
  for (const std::string& warning : r.warnings) fmt::print("  note: {}\n", warning);
}

/// keep, auto, or the confidence from which a vertex is tooth.
std::optional<double> skirt_threshold(const std::string& text) {
  if (text == "keep") return std::nullopt;
  if (text == "auto") return 0.5;
  double value = 0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (failure != std::errc() || end != text.data() + text.size() || !(value > 0 && value < 1))
    throw UsageError("--skirt takes keep, auto, or a confidence between 0 and 1.");
  return value;
}

/// The input with what the skirt network thinks of its vertices.
MeshFile confidence_file(const MeshFile& crown, const CompletionRecord& record) {
  MeshFile file;
  file.mesh = crown.mesh;
  VertexAttribute confidence{AttributeType::float32, {}};
  for (const float c : record.tooth_confidence) confidence.values.push_back(static_cast<double>(c));
  file.vertex_attributes["confidence"] = std::move(confidence);
  VertexAttribute kept{AttributeType::uint8, std::vector<double>(crown.mesh.vertices.size(), 0)};
  for (const int v : record.kept_vertices) kept.values[static_cast<std::size_t>(v)] = 1;
  file.vertex_attributes["kept"] = std::move(kept);
  file.comments = {"confidence: that a vertex is tooth and not skirt, 0 to 1; -1 not judged", "kept: 1 in the tooth"};
  return file;
}

void run(const CompleteCommand& command) {
  if (const std::string warning = blas_warning(); !warning.empty()) fmt::print(stderr, "rhizodont: {}\n", warning);
  require_savable(command.output);
  if (!command.report.empty()) require_writable_place(command.report);
  const MeshFile crown = load_mesh(command.crown);
  const CompletionModels models =
      CompletionModels::load(command.models.empty() ? default_models_folder() : std::filesystem::path(command.models));
  CompleteOptions options = command.options;
  if (command.fdi != 0) options.fdi = command.fdi;
  options.skirt = skirt_threshold(command.skirt);
  if (!command.confidence.empty()) {
    if (!options.skirt) throw UsageError("A confidence is there only where a skirt is looked for (--skirt auto).");
    require_savable(command.confidence);
  }
  const ProgressCallback progress = progress_line(command.quiet);
  std::vector<CompletedTooth> candidates;
  try {
    candidates = complete_candidates(crown.mesh, models, command.candidates, options, progress);
  } catch (const InputError& error) {
    clear_line(progress);
    throw in_terms_of_file(error, crown);
  } catch (...) {
    clear_line(progress);
    throw;
  }
  clear_line(progress);
  const std::string sha256 = sha256_of_file(command.crown);
  std::vector<std::filesystem::path> written;
  try {
    if (!command.confidence.empty()) {
      written.emplace_back(command.confidence);
      save_mesh(command.confidence, confidence_file(crown, candidates.front().record));
    }
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      written.push_back(numbered(command.output, i));
      save_mesh(written.back(), tooth_file(candidates[i], crown));
      refer_to_file(candidates[i].record, crown, command.output);
      if (command.report.empty()) continue;
      written.push_back(numbered(command.report, i));
      write_file_atomically(written.back(), completion_report(candidates[i], options, command.crown, sha256));
    }
  } catch (...) {
    for (const auto& file : written) std::filesystem::remove(file);  // all or nothing
    throw;
  }
  if (command.quiet) return;
  for (std::size_t i = 0; i < candidates.size(); ++i)
    print_summary(candidates[i], numbered(command.output, i).string());
}

}  // namespace

void add_complete_command(CLI::App& app) {
  auto command = std::make_shared<CompleteCommand>();
  CLI::App* complete = app.add_subcommand("complete", "A whole tooth with a root from a scanned crown");
  complete->add_option("CROWN", command->crown, "Crown mesh: .stl .ply .obj .off .vtp .vtk, also .gz")->required();
  complete->add_option("-o,--output", command->output, "Where the tooth goes: .ply .stl .obj .glb")->required();
  complete->add_option("--fdi", command->fdi, "FDI number of the tooth, 11-48; without it the type is guessed");
  complete->add_option("--report", command->report, "Write the report (JSON) to this file");
  complete->add_option("--e", command->options.e, "Side of the lattice in mm, 0.2 to 2; new edges are about half of it")
      ->capture_default_str();
  complete->add_option("--cap", command->options.cap, "A cap that closes the crown's base: drop, keep")
      ->transform(CLI::CheckedTransformer(cap_names))
      ->default_str("drop");
  complete
      ->add_option("--skirt", command->skirt,
                   "Gum and webs around the crown: keep, auto (drop), or drop below this CONFIDENCE of being tooth")
      ->capture_default_str();
  complete->add_option("--skirt-confidence", command->confidence,
                       "Write the crown with the confidence of each vertex to this file (.ply)");
  complete->add_flag("--repair", command->options.repair,
                     "Mend a defective crown first: merges, drops and turns, each listed in the report");
  complete->add_option("--unit", command->options.millimetres_per_unit, "Unit of the crown's file: mm, cm, in, m")
      ->transform(CLI::CheckedTransformer(unit_names))
      ->default_str("mm");
  complete->add_option("--transition", command->options.transition,
                       "Width in mm of the smoothed band beside the crown, 0 to 5; chosen if not given");
  RootSteering& steering = command->options.steering;
  complete->add_option("--root-length", steering.length_mm,
                       "Length of the root in mm, such as measured on an X-ray: lowest point of the crown to the apex");
  complete->add_option("--root-tip", steering.tip_degrees, "Turn the root, degrees; positive: apex towards distal");
  complete->add_option("--root-torque", steering.torque_degrees,
                       "Turn the root, degrees; positive: apex towards tongue or palate");
  complete->add_option("--root-bend", steering.bend_degrees,
                       "Bend the root's lower half, degrees; positive: apex towards distal");
  complete
      ->add_option("--candidates", command->candidates,
                   "Number of teeth: the expected one, then others (OUTPUT_2, ...) over the interval of root length")
      ->capture_default_str();
  complete->add_option("--threads", command->options.threads, "At most so many threads; 0 = all")
      ->capture_default_str();
  complete->add_option("--models", command->models, "Folder with completion.safetensors and atlas.safetensors");
  complete->add_flag("--quiet", command->quiet, "Print nothing but errors");
  complete->callback([command] { run(*command); });
}

}  // namespace rhizodont::command_line
