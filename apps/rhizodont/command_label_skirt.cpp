// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "command_line/output_checks.hpp"
#include "commands.hpp"
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
};

void run(const LabelSkirtCommand& command) {
  require_ending(command.output, {".ply"}, "a labelled crown");
  require_safe_outputs({command.crown, command.restored}, {command.output});
  MeshFile crown = load_mesh(command.crown);
  const MeshFile restored = load_mesh(command.restored);
  const std::vector<std::uint8_t> labels = label_by_restored(crown.mesh, restored.mesh, command.tolerance_mm);
  save_mesh(command.output, labelled_crown_file(std::move(crown), labels));
  const auto tooth = std::count(labels.begin(), labels.end(), 1);
  fmt::print("{}: {} of {} vertices are tooth, {} skirt\n", command.output, tooth, labels.size(),
             static_cast<std::ptrdiff_t>(labels.size()) - tooth);
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
  label->callback([command] { run(*command); });
}

}  // namespace rhizodont::command_line
