// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "commands.hpp"
#include "learning/blas.hpp"
#include "rhizodont/complete.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/io.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <filesystem>
#include <map>
#include <memory>
#include <string>

namespace rhizodont::command_line {
namespace {

struct CompleteCommand {
  std::string crown;
  std::string output;
  std::string report;
  std::string models;
  int fdi = 0;
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

MeshFile as_file(const CompletedTooth& tooth) {
  MeshFile file;
  file.mesh = tooth.mesh;
  VertexAttribute source{AttributeType::uint8, {}};
  for (const VertexSource s : tooth.source) source.values.push_back(static_cast<double>(s));
  file.vertex_attributes[source_attribute] = std::move(source);
  file.comments = {"whole tooth: scanned crown with a predicted root, not the patient's anatomy",
                   "source: 0 scan, 1 transition, 2 predicted"};
  return file;
}

void print_summary(const CompletedTooth& tooth, const std::string& output) {
  const CompletionRecord& r = tooth.record;
  double seconds = 0;
  for (const StageRecord& stage : r.stages) seconds += stage.seconds;
  fmt::print(
      "{}: tooth {}{}, {} of {} crown triangles kept bit for bit, root {:.1f} mm, new triangles Q {:.3f}, {:.2f} s\n",
      output, r.fdi, r.fdi_guessed ? " (guessed)" : "", r.kept_triangles, r.crown_triangles, r.root_length_mm,
      r.new_triangles.q_avg, seconds);
  for (const std::string& warning : r.warnings) fmt::print("  note: {}\n", warning);
}

void run(const CompleteCommand& command) {
  if (const std::string warning = blas_warning(); !warning.empty()) fmt::print(stderr, "rhizodont: {}\n", warning);
  const MeshFile crown = load_mesh(command.crown);
  const CompletionModels models =
      CompletionModels::load(command.models.empty() ? default_models_folder() : std::filesystem::path(command.models));
  CompleteOptions options = command.options;
  if (command.fdi != 0) options.fdi = command.fdi;
  const ProgressCallback progress = progress_line(command.quiet);
  CompletedTooth tooth;
  try {
    tooth = complete_tooth(crown.mesh, models, options, progress);
  } catch (...) {
    clear_line(progress);
    throw;
  }
  clear_line(progress);
  const std::string report = completion_report(tooth, options, command.crown, sha256_of_file(command.crown));
  save_mesh(command.output, as_file(tooth));
  if (!command.report.empty()) {
    try {
      write_file_atomically(command.report, report);
    } catch (...) {
      std::filesystem::remove(command.output);  // all or nothing
      throw;
    }
  }
  if (!command.quiet) print_summary(tooth, command.output);
}

}  // namespace

void add_complete_command(CLI::App& app) {
  auto command = std::make_shared<CompleteCommand>();
  CLI::App* complete = app.add_subcommand("complete", "A whole tooth with a root from a scanned crown");
  complete->add_option("CROWN", command->crown, "Crown mesh: .stl .ply .obj .off .vtp")->required();
  complete->add_option("-o,--output", command->output, "Where the tooth goes: .ply .stl .obj .glb")->required();
  complete->add_option("--fdi", command->fdi, "FDI number of the tooth, 11-48; without it the type is guessed");
  complete->add_option("--report", command->report, "Write the report (JSON) to this file");
  complete->add_option("--e", command->options.e, "Side of the lattice in mm, 0.2 to 2; new edges are about half of it")
      ->capture_default_str();
  complete->add_option("--cap", command->options.cap, "A cap that closes the crown's base: drop, keep")
      ->transform(CLI::CheckedTransformer(cap_names))
      ->default_str("drop");
  complete->add_option("--unit", command->options.millimetres_per_unit, "Unit of the crown's file: mm, cm, in, m")
      ->transform(CLI::CheckedTransformer(unit_names))
      ->default_str("mm");
  complete->add_option("--transition", command->options.transition, "Width in mm of the smoothed band beside the crown")
      ->capture_default_str();
  complete->add_option("--threads", command->options.threads, "At most so many threads; 0 = all")
      ->capture_default_str();
  complete->add_option("--models", command->models, "Folder with completion.safetensors and atlas.safetensors");
  complete->add_flag("--quiet", command->quiet, "Print nothing but errors");
  complete->callback([command] { run(*command); });
}

}  // namespace rhizodont::command_line
