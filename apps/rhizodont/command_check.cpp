// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "commands.hpp"
#include "evaluation/json.hpp"
#include "json_option.hpp"
#include "rhizodont/check.hpp"
#include "rhizodont/complete.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/io.hpp"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <fstream>
#include <memory>
#include <string>

namespace rhizodont::command_line {
namespace {

struct CheckCommand {
  std::string crown, tooth;
  std::string report;
  CheckOptions options;
  JsonOption json;
};

void row(const char* name, const std::string& value) { fmt::print("  {:<36}{}\n", name, value); }

template <class Number>
void row(const char* name, Number value, const char* unit = "") {
  row(name, fmt::format("{}{}", value, unit));
}

void print_quality(const char* title, const std::optional<QualityFigures>& figures) {
  if (!figures) return;
  fmt::print("{} ({})\n", title, figures->triangles);
  row("Q mean, least", fmt::format("{:.4f}, {:.4f}", figures->q_avg, figures->q_min));
  row("smallest angle mean, least", fmt::format("{:.2f}, {:.2f} degrees", figures->theta_avg, figures->theta_min));
  row("largest angle", fmt::format("{:.2f} degrees", figures->theta_max));
  row("angles under 30 degrees", fmt::format("{:.3f} %", figures->percent_below_30));
}

void print_table(const CheckReport& report) {
  const CrownCheck& crown = report.crown;
  fmt::print("Promise 1, the crown is exact: {}\n", crown.holds ? "kept" : "NOT KEPT");
  row("coordinates compared as", std::string(crown.compared_as_float ? "float" : "double"));
  row("crown triangles kept",
      fmt::format("{} of {} ({:.3f} %)", crown.kept_triangles, crown.triangles, 100 * crown.kept_share));
  row("crown triangles broken", crown.broken_triangles.size());
  if (crown.repaired_triangles > 0) row("crown triangles repaired", crown.repaired_triangles);
  row("crown vertices kept", fmt::format("{} of {}", crown.kept_vertices, crown.vertices));
  row("crown vertices dropped", crown.dropped_vertices.size());
  if (crown.deviation) {
    const auto& bins = crown.deviation->bins;
    row("deviation of crown, largest, mean",
        fmt::format("{:.6f}, {:.6f} mm", crown.deviation->max, crown.deviation->mean));
    row("vertices to 1e-3, 1e-2, 1e-1, over", fmt::format("{}, {}, {}, {}", bins[0], bins[1], bins[2], bins[3]));
  }
  const SolidCheck& solid = report.solid;
  fmt::print("Promise 2, the tooth is a solid: {}\n", solid.holds ? "kept" : "NOT KEPT");
  row("vertices, triangles", fmt::format("{}, {}", solid.vertices, solid.triangles));
  row("border edges", solid.border_edges);
  row("non-manifold edges, vertices", fmt::format("{}, {}", solid.non_manifold_edges, solid.non_manifold_vertices));
  row("misoriented edges", solid.misoriented_edges);
  row("unreferenced vertices", solid.unreferenced_vertices);
  row("pieces", solid.components);
  row("Euler number, genus",
      fmt::format("{}, {}", solid.euler_number, solid.genus ? std::to_string(*solid.genus) : "-"));
  row("volume", fmt::format("{:.3f} mm3", solid.volume));
  row("self-intersecting pairs", solid.self_intersections.size());
  fmt::print("Promise 3, new triangles are good: {}\n", report.new_triangles.holds() ? "kept" : "not kept");
  print_quality("New triangles", report.new_triangles.all);
  print_quality("New triangles that touch no crown vertex", report.new_triangles.inner);
  print_quality("New triangles along the crown's border", report.new_triangles.at_border);
  print_quality("All triangles", report.all_triangles);
  for (const std::string& failure : report.failures) fmt::print("- {}\n", failure);
}

/// The triangles that the report of `complete --repair` lists. Throws InputError for a report on another file.
std::vector<int> repaired_triangles(const std::string& report_file, const std::string& crown_file) {
  std::ifstream stream(report_file);
  if (!stream) throw InputError(fmt::format("The file {} cannot be read.", report_file));
  try {
    const auto report = nlohmann::json::parse(stream);
    if (report.at("input").at("sha256").get<std::string>() != sha256_of_file(crown_file))
      throw InputError(fmt::format("{} is the report on another crown than {}.", report_file, crown_file));
    std::vector<int> ids;
    for (const auto& step : report.at("repairs"))
      for (const auto& id : step.at("triangles")) ids.push_back(id.get<int>());
    return ids;
  } catch (const nlohmann::json::exception&) {
    throw InputError(fmt::format("{} is not a report of rhizodont complete.", report_file));
  }
}

void run(const CheckCommand& command) {
  const MeshFile crown = load_mesh(command.crown);
  const MeshFile tooth = load_mesh(command.tooth);
  CheckOptions options = command.options;
  if (!command.report.empty()) options.repaired_triangles = repaired_triangles(command.report, command.crown);
  const CheckReport report = check(crown.mesh, tooth.mesh, options);
  if (command.json.wants_table()) print_table(report);
  command.json.write(report);
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
      ->add_option("--least-kept", command->options.least_kept_share,
                   "Least share of the crown's triangles that must be in the tooth, 0 to 1")
      ->capture_default_str();
  check_app->add_option("--report", command->report,
                        "Report of 'complete --repair': triangles that it lists as repaired are not demanded");
  command->json.add_to(*check_app);
  check_app->callback([command] { run(*command); });
}

}  // namespace rhizodont::command_line
