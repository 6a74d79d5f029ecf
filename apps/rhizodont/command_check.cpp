// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "command_line/output_checks.hpp"
#include "command_line/output_options.hpp"
#include "command_line/terminal.hpp"
#include "commands.hpp"
#include "mesh_detail.hpp"
#include "report/json.hpp"
#include "rhizodont/check.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/io.hpp"
#include "rhizodont/report.hpp"
#include "table_row.hpp"

#include <fmt/core.h>

#include <memory>
#include <string>

namespace rhizodont::command_line {
namespace {

struct CheckCommand {
  std::string crown, tooth;
  std::string report;
  CheckOptions options;
  OutputOptions said;
};

template <class Number>
void print_number(const char* name, Number value) {
  print_table_row(name, fmt::format("{}", value));
}

void print_quality(const char* title, const std::optional<QualityFigures>& figures) {
  if (!figures) return;
  fmt::print("{} ({})\n", title, figures->triangles);
  print_table_row("Q mean, least", fmt::format("{:.4f}, {:.4f}", figures->q_avg, figures->q_min));
  print_table_row("smallest angle mean, least",
                  fmt::format("{:.2f}, {:.2f} degrees", figures->theta_avg, figures->theta_min));
  print_table_row("largest angle", fmt::format("{:.2f} degrees", figures->theta_max));
  print_table_row("angles under 30 degrees", fmt::format("{:.3f} %", figures->percent_below_30));
}

std::string kept_or_not(bool holds) {
  return holds ? coloured(stdout, TextColour::green, "kept") : coloured(stdout, TextColour::red, "NOT KEPT");
}

void print_table(const CheckReport& report) {
  const CrownCheck& crown = report.crown;
  fmt::print("Promise 1, the crown is exact: {}\n", kept_or_not(crown.holds));
  print_table_row("coordinates compared as", std::string(crown.compared_as_float ? "float" : "double"));
  print_table_row("crown triangles kept",
                  fmt::format("{} of {} ({:.3f} %)", crown.kept_triangles, crown.triangles, 100 * crown.kept_share));
  print_number("crown triangles broken", crown.broken_triangles.size());
  if (crown.merged_vertices > 0)
    print_table_row("crown vertices merged across seams",
                    fmt::format("{}, at most {:.6f} mm apart", crown.merged_vertices, crown.merged_distance_max));
  if (crown.repaired_triangles > 0) print_number("crown triangles repaired", crown.repaired_triangles);
  print_table_row("crown vertices kept", fmt::format("{} of {}", crown.kept_vertices, crown.vertices));
  print_number("crown vertices dropped", crown.dropped_vertices.size());
  if (crown.deviation) {
    const auto& bins = crown.deviation->bins;
    print_table_row("deviation of crown, largest, mean",
                    fmt::format("{:.6f}, {:.6f} mm", crown.deviation->max, crown.deviation->mean));
    print_table_row("vertices to 1e-3, 1e-2, 1e-1, over",
                    fmt::format("{}, {}, {}, {}", bins[0], bins[1], bins[2], bins[3]));
  }
  const SolidCheck& solid = report.solid;
  fmt::print("Promise 2, the tooth is a solid: {}\n", kept_or_not(solid.holds));
  print_table_row("vertices, triangles", fmt::format("{}, {}", solid.vertices, solid.triangles));
  print_number("border edges", solid.border_edges);
  print_table_row("non-manifold edges, vertices",
                  fmt::format("{}, {}", solid.non_manifold_edges, solid.non_manifold_vertices));
  print_number("misoriented edges", solid.misoriented_edges);
  print_number("unreferenced vertices", solid.unreferenced_vertices);
  print_number("pieces", solid.components);
  print_table_row("Euler number, genus",
                  fmt::format("{}, {}", solid.euler_number, solid.genus ? std::to_string(*solid.genus) : "-"));
  print_table_row("volume", fmt::format("{:.3f} mm3", solid.volume));
  print_number("self-intersecting pairs", solid.self_intersections.size());
  fmt::print("Promise 3, new triangles are good: {}\n", report.new_triangles.holds() ? "kept" : "not kept");
  print_quality("New triangles", report.new_triangles.all);
  print_quality("New triangles that touch no crown vertex", report.new_triangles.inner);
  print_quality("New triangles along the crown's border", report.new_triangles.at_border);
  print_quality("All triangles", report.all_triangles);
  for (const std::string& failure : report.failures) fmt::print("- {}\n", failure);
}

/// Without the report nothing is known of what was mended or taken for no part of the tooth.
void tell_of_report(const CheckCommand& command, const CheckReport& report) {
  if (!command.report.empty() || report.crown.holds || report.crown.kept_triangles == 0) return;
  command.said.tell(
      "If 'complete' dropped specks, cap or skirt, or repaired the crown, say so with its report: --report FILE. What "
      "it "
      "lists is not demanded.");
}

/// Read once: a pipe gives its bytes only once.
MeshFile read_crown(const std::string& path, std::string& sha256) {
  try {
    const std::string bytes = read_file_bytes(path);
    sha256 = sha256_of_bytes(bytes);
    return read_mesh(bytes, path);
  } catch (const InputError& error) {
    throw error.reworded(path + ": " + error.what());
  }
}

void run(const CheckCommand& command) {
  std::vector<std::filesystem::path> inputs{command.crown, command.tooth};
  if (!command.report.empty()) inputs.emplace_back(command.report);
  require_safe_outputs(inputs, command.said.outputs());
  std::string sha256;
  const MeshFile crown = read_crown(command.crown, sha256);
  const MeshFile tooth = load_mesh(command.tooth);
  detail_of_mesh(command.said, command.crown, crown);
  detail_of_mesh(command.said, command.tooth, tooth);
  CheckOptions options = command.options;
  if (!command.report.empty()) {
    options = allowing_for(excused_by_report(command.report, sha256, crown.file_vertices));
    options.least_kept_share = command.options.least_kept_share;
  }
  const CheckReport report = check(crown.mesh, tooth.mesh, options);
  if (command.said.wants_words()) print_table(report);
  tell_of_report(command, report);
  write_output_files(command.said.print_or_file(report));
  if (!report.holds()) exit_with(static_cast<int>(ErrorCode::no_result));
}

}  // namespace

void add_check_command(CLI::App& app) {
  auto command = std::make_shared<CheckCommand>();
  CLI::App* check_app = app.add_subcommand(
      "check",
      "Prove that a tooth keeps its crown to the bit and is a closed solid, however it was made (exit 0 or 4)");
  check_app->add_option("CROWN", command->crown, "The crown as scanned (.stl .ply .obj .off .vtp)")->required();
  check_app->add_option("TOOTH", command->tooth, "The completed tooth")->required();
  check_app
      ->add_option(
          "--least-kept", command->options.least_kept_share,
          "Least share of the crown's triangles that must be in the tooth, 0 to 1; with --report without cap and "
          "skirt")
      ->capture_default_str();
  check_app->add_option("--report", command->report,
                        "Report of 'complete': what it lists as cap, skirt, speck or repaired is not demanded");
  command->said.add_with_figures_to(*check_app);
  check_app->callback([command] { run(*command); });
}

}  // namespace rhizodont::command_line
