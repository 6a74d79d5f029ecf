// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "command_line/output_checks.hpp"
#include "command_line/output_options.hpp"
#include "commands.hpp"
#include "mesh_detail.hpp"
#include "report/json.hpp"
#include "rhizodont/io.hpp"
#include "rhizodont/measure.hpp"
#include "table_row.hpp"

#include <fmt/core.h>

#include <memory>
#include <string>

namespace rhizodont::command_line {
namespace {

struct MeasureCommand {
  std::string mesh;
  OutputOptions said;
};

void print_table(const MeshMeasures& m) {
  fmt::print("Triangles\n");
  print_table_row("Q mean, least", fmt::format("{:.4f}, {:.4f}", m.quality.q_avg, m.quality.q_min));
  print_table_row("smallest angle mean, least",
                  fmt::format("{:.2f}, {:.2f} degrees", m.quality.theta_avg, m.quality.theta_min));
  print_table_row("largest angle", fmt::format("{:.2f} degrees", m.quality.theta_max));
  print_table_row("angles under 30 degrees", fmt::format("{:.3f} %", m.quality.percent_below_30));
  fmt::print("Topology\n");
  print_table_row("vertices, edges, triangles", fmt::format("{}, {}, {}", m.vertices, m.edges, m.triangles));
  print_table_row("pieces", std::to_string(m.components));
  print_table_row("closed", m.closed ? "yes" : "no");
  print_table_row("border edges, loops", fmt::format("{}, {}", m.border_edges, m.border_loops));
  print_table_row("Euler number, genus",
                  fmt::format("{}, {}", m.euler_number, m.genus ? std::to_string(*m.genus) : "-"));
  print_table_row("self-intersecting pairs", std::to_string(m.self_intersections));
  fmt::print("Size\n");
  print_table_row("volume", m.closed ? fmt::format("{:.3f} mm3", m.volume) : "- (not closed)");
  print_table_row("area", fmt::format("{:.3f} mm2", m.area));
  for (std::size_t i = 0; i < 3; ++i)
    print_table_row(i == 0   ? "from, to, extent in x"
                    : i == 1 ? "from, to, extent in y"
                             : "from, to, extent in z",
                    fmt::format("{:.3f}, {:.3f}, {:.3f} mm", m.lowest[i], m.highest[i], m.highest[i] - m.lowest[i]));
  print_table_row("edge least, mean, largest",
                  fmt::format("{:.4f}, {:.4f}, {:.4f} mm", m.edge_min, m.edge_mean, m.edge_max));
  for (const std::string& defect : m.defects) fmt::print("- {}\n", defect);
}

void run(const MeasureCommand& command) {
  require_safe_outputs({command.mesh}, command.said.outputs());
  const MeshFile file = load_mesh(command.mesh);
  detail_of_mesh(command.said, command.mesh, file);
  const MeshMeasures measures = measure(file.mesh);
  if (command.said.wants_words()) print_table(measures);
  write_output_files(command.said.print_or_file(measures));
}

}  // namespace

void add_measure_command(CLI::App& app) {
  auto command = std::make_shared<MeasureCommand>();
  CLI::App* measure_app = app.add_subcommand(
      "measure", "Triangle quality, topology, volume and sizes of any mesh (.stl .ply .obj .off .vtp)");
  measure_app->add_option("MESH", command->mesh, "The mesh")->required();
  command->said.add_with_figures_to(*measure_app);
  measure_app->callback([command] { run(*command); });
}

}  // namespace rhizodont::command_line
