// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "command_line/output_checks.hpp"
#include "command_line/output_options.hpp"
#include "command_line/terminal.hpp"
#include "commands.hpp"
#include "doctor/examine.hpp"
#include "models_option.hpp"
#include "rhizodont/output_files.hpp"
#include "table_row.hpp"

#include <fmt/core.h>

#include <memory>
#include <string>

namespace rhizodont::command_line {
namespace {

struct DoctorCommand {
  std::string models;
  OutputOptions said;
};

std::string state_of(const doctor::ModelFinding& model) {
  if (!model.is_there) return model.is_needed ? "MISSING" : "not there";
  if (!model.fault.empty()) return "DAMAGED";
  std::string text = fmt::format("{}, {:.1f} MB", model.is_shipped ? "as shipped" : "not the shipped one",
                                 static_cast<double>(model.bytes) / 1e6);
  if (!model.version.empty()) text += ", " + model.version;
  if (!model.trained.empty()) text += ", trained " + model.trained;
  return text;
}

void print_self_test(const doctor::SelfTest& test) {
  fmt::print("Self test, a canine of {} triangles\n", test.crown_triangles);
  print_table_row("models loaded in", fmt::format("{:.2f} s", test.loading_seconds));
  print_table_row("completed in",
                  fmt::format("{:.2f} s, root {:.1f} mm", test.completing_seconds, test.root_length_mm));
  print_table_row("checked in", fmt::format("{:.2f} s", test.checking_seconds));
  print_table_row("crown triangles kept", fmt::format("{} of {}", test.kept_triangles, test.crown_triangles));
}

std::string verdict(const doctor::Examination& found) {
  if (!found.faults.empty()) return coloured(stdout, TextColour::red, "It does not work.");
  if (found.warnings.empty()) return coloured(stdout, TextColour::green, "All is well.");
  return coloured(stdout, TextColour::yellow, "It works, but for what the warnings say.");
}

void print_table(const doctor::Examination& found, bool is_verbose) {
  fmt::print("rhizodont {}{}\n", found.version, found.has_pages ? "" : ", without its pages");
  for (const auto& [name, version] : found.libraries) print_table_row(name.c_str(), version);
  print_table_row("linear algebra library (BLAS)",
                  found.blas.path.empty() ? "none loaded: the program needs none" : found.blas.path);
  const doctor::Machine& machine = found.machine;
  fmt::print("Machine\n");
  print_table_row("processors, threads", fmt::format("{}, {}", machine.processors, machine.threads));
  print_table_row("memory, free", fmt::format("{:.0f} MB, {:.0f} MB", machine.memory_mb, machine.free_memory_mb));
  fmt::print("Models in {}\n", found.models_folder.string());
  for (const doctor::ModelFinding& model : found.models) {
    print_table_row(model.name.c_str(), state_of(model));
    if (!model.sha256.empty()) print_table_row("", is_verbose ? model.sha256 : model.sha256.substr(0, 16));
  }
  if (found.self_test) print_self_test(*found.self_test);
  for (const std::string& warning : found.warnings)
    fmt::print("{} {}\n", coloured(stdout, TextColour::yellow, "warning:"), warning);
  for (const std::string& fault : found.faults)
    fmt::print("{} {}\n", coloured(stdout, TextColour::red, "fault:"), fault);
  fmt::print("{}\n", verdict(found));
}

void run(const DoctorCommand& command) {
  const std::filesystem::path folder = models_folder(command.models, command.said);
  require_safe_outputs(files_below(folder), command.said.outputs());
  const doctor::Examination found = doctor::examine(folder);
  if (command.said.wants_words()) print_table(found, command.said.is_verbose());
  write_output_files(command.said.print_or_file(found));
  if (command.said.is_quiet())
    for (const std::string& fault : found.faults) print_error("rhizodont", fault);
  if (found.code) exit_with(static_cast<int>(*found.code));
}

}  // namespace

void add_doctor_command(CLI::App& app) {
  auto command = std::make_shared<DoctorCommand>();
  CLI::App* doctor_app = app.add_subcommand(
      "doctor", "Whether all is there and works: machine, libraries, models, and a crown completed and proved");
  add_models_option(*doctor_app, command->models);
  command->said.add_with_figures_to(*doctor_app);
  doctor_app->callback([command] { run(*command); });
}

}  // namespace rhizodont::command_line
