// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "command_line/output_checks.hpp"
#include "command_line/output_options.hpp"
#include "command_line/terminal.hpp"
#include "commands.hpp"
#include "families/registered_templates.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/io.hpp"
#include "rhizodont/output_files.hpp"
#include "teeth/label_numbers.hpp"

#include <fmt/core.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace rhizodont::command_line {
namespace {

struct RegisterCommand {
  std::filesystem::path teeth, data, output;
  std::string numbers = "fdi", jaw;
  bool overwrite = false;
  RegisterToothOptions options;
  OutputOptions said;
};

nlohmann::ordered_json figures_of(const RegisteredTooth& tooth, const ToothFile& file) {
  return {{"file", file.path.filename().string()},
          {"fdi", file.fdi},
          {"mean_mm", tooth.mean_mm},
          {"mean_before_bending_mm", tooth.rigid_mean_mm},
          {"within_95_percent_mm", tooth.percentile_95_mm},
          {"size_ratio", tooth.size_ratio}};
}

void say_refusal(const std::string& file, const std::string& why) {
  print_error("rhizodont", (why.find(file) == std::string::npos ? file + ": " : "") + why);
}

void run(const RegisterCommand& command) {
  require_folder_name(command.output, "registered teeth");
  if (!(command.options.largest_mean_mm > 0)) throw UsageError("--largest-distance takes a distance above 0 mm.");
  ToothFileOptions naming;
  naming.numbers = read_label_numbers(command.numbers);
  if (!command.jaw.empty()) naming.jaw = command.jaw == "upper" ? Jaw::upper : Jaw::lower;
  const std::vector<ToothFile> files = find_tooth_files(command.teeth, naming);
  std::vector<std::filesystem::path> outputs;
  for (const ToothFile& file : files) outputs.push_back(command.output / registered_name(file));
  require_new(outputs, command.overwrite);
  std::vector<std::filesystem::path> inputs = files_below(command.data / "templates");
  for (const ToothFile& file : files) inputs.push_back(file.path);
  std::vector<std::filesystem::path> written = outputs;
  for (const auto& file : command.said.outputs()) written.push_back(file);
  require_safe_outputs(inputs, written);
  const auto templates = load_template_files(command.data);
  nlohmann::ordered_json figures = nlohmann::ordered_json::array();
  std::size_t refused = 0;
  for (std::size_t i = 0; i < files.size(); ++i) {
    try {
      const RegisteredTooth tooth =
          register_tooth(load_mesh(files[i].path).mesh, files[i].fdi, templates, command.options);
      require_growable(tooth, files[i].fdi, templates);
      const auto type = static_cast<std::size_t>(tooth_type_of_fdi(files[i].fdi));
      write_output_files(
          {{outputs[i], mesh_file_bytes(outputs[i], registered_file(tooth, templates[type], files[i]))}});
      figures.push_back(figures_of(tooth, files[i]));
      command.said.tell(fmt::format(
          "{}: {}, {:.3f} mm apart ({:.2f} before bending), 95 % within {:.2f} mm, {:.2f} times the template's size",
          outputs[i].string(), files[i].fdi, tooth.mean_mm, tooth.rigid_mean_mm, tooth.percentile_95_mm,
          tooth.size_ratio));
    } catch (const InputError& error) {
      ++refused;
      figures.push_back(
          {{"file", files[i].path.filename().string()}, {"fdi", files[i].fdi}, {"refusal", error.what()}});
      say_refusal(files[i].path.string(), error.what());
    }
    std::fflush(stdout);
  }
  command.said.tell(fmt::format("{} of {} teeth registered", files.size() - refused, files.size()));
  write_output_files(command.said.print_or_file({{"teeth", figures}}));
  if (refused == files.size()) exit_with(static_cast<int>(ErrorCode::no_result));
  if (refused > 0) exit_with(static_cast<int>(ErrorCode::partial));
}

}  // namespace

void add_register_command(CLI::App& app) {
  auto command = std::make_shared<RegisterCommand>();
  CLI::App* register_app =
      app.add_subcommand("register", "Bring whole teeth of people into correspondence with the families' templates");
  register_app
      ->add_option("TEETH_DIR", command->teeth,
                   "Folder with closed whole teeth in mm, named by number: tooth_36.ply, 36_anna.stl")
      ->required();
  register_app->add_option("--data", command->data, "Folder with templates/")->required();
  register_app->add_option("-o,--output", command->output, "Folder for registered teeth, tooth_FDI_NAME.ply")
      ->required();
  register_app->add_option("--labels-are", command->numbers, "What the numbers in the files' names are")
      ->check(CLI::IsMember({"fdi", "universal", "arch14", "arch16"}))
      ->capture_default_str();
  register_app->add_option("--jaw", command->jaw, "upper or lower, for numbers along the arch")
      ->check(CLI::IsMember({"upper", "lower"}));
  register_app
      ->add_option("--largest-distance", command->options.largest_mean_mm,
                   "Refuse what stays further from its template on average, mm")
      ->capture_default_str();
  register_app->add_flag("--overwrite", command->overwrite, "Registered teeth of the same names are replaced");
  command->said.add_with_figures_to(*register_app);
  register_app->callback([command] { run(*command); });
}

}  // namespace rhizodont::command_line
