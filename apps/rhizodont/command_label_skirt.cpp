// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "command_line/output_checks.hpp"
#include "command_line/output_options.hpp"
#include "commands.hpp"
#include "mesh_detail.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/io.hpp"
#include "training/skirt_sample.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>

namespace rhizodont::command_line {
namespace {

struct LabelSkirtCommand {
  std::string crown, restored, output;
  double tolerance_mm = 0.05;
  OutputOptions said;
};

void run(const LabelSkirtCommand& command) {
  require_ending(command.output, {".ply"}, "a labelled crown");
  const OutputOptions& said = command.said;
  std::vector<std::filesystem::path> outputs = said.outputs();
  outputs.emplace_back(command.output);
  require_safe_outputs({command.crown, command.restored}, outputs);
  MeshFile crown = load_mesh(command.crown);
  const MeshFile restored = load_mesh(command.restored);
  detail_of_mesh(said, command.crown, crown);
  detail_of_mesh(said, command.restored, restored);
  const std::vector<std::uint8_t> labels = label_by_restored(crown.mesh, restored.mesh, command.tolerance_mm);
  const std::ptrdiff_t tooth = std::count(labels.begin(), labels.end(), 1);
  const std::ptrdiff_t skirt = static_cast<std::ptrdiff_t>(labels.size()) - tooth;
  const nlohmann::ordered_json figures{{"vertices", labels.size()}, {"tooth", tooth}, {"skirt", skirt}};
  std::vector<OutputFile> files = said.figures_file(figures);
  files.push_back({command.output, mesh_file_bytes(command.output, labelled_crown_file(std::move(crown), labels))});
  write_output_files(files);
  said.print_figures(figures);
  if (said.wants_words())
    fmt::print("{}: {} of {} vertices are tooth, {} skirt\n", command.output, tooth, labels.size(), skirt);
}

}  // namespace

void add_label_skirt_command(CLI::App& app) {
  auto command = std::make_shared<LabelSkirtCommand>();
  CLI::App* label = app.add_subcommand(
      "label-skirt", "Label a crown's vertices by its restored model: on its surface tooth, else skirt");
  label->add_option("CROWN", command->crown, "Crown as cut from a scan: .stl .ply .obj .off .vtp")->required();
  label->add_option("RESTORED", command->restored, "The restored, complete tooth in the same place")->required();
  label->add_option("-o,--output", command->output, "The crown with the vertex attribute 'tooth' (.ply)")->required();
  label->add_option("--tolerance", command->tolerance_mm, "How far off the surface a vertex is still tooth, mm")
      ->capture_default_str();
  command->said.add_with_figures_to(*label);
  label->callback([command] { run(*command); });
}

}  // namespace rhizodont::command_line
