// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/tooth_labels.hpp"
#include "command_line/output_checks.hpp"
#include "command_line/output_options.hpp"
#include "commands.hpp"
#include "io/scan_labels.hpp"
#include "io/write_labels.hpp"
#include "mesh_detail.hpp"
#include "models_option.hpp"
#include "report/json.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/io.hpp"
#include "rhizodont/models.hpp"
#include "rhizodont/output_files.hpp"
#include "rhizodont/segment.hpp"
#include "segment_options.hpp"
#include "teeth/label_numbers.hpp"
#include "unit_option.hpp"

#include <fmt/core.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace rhizodont::command_line {
namespace {

struct SegmentCommand {
  std::string scan, output, models;
  FoundTeethOptions teeth;
  SegmentOptions options;
  LabelNumbers numbers = LabelNumbers::fdi;
  bool overwrite = false;
  OutputOptions said;
};

/// The labels in the dialect that the file's name asks for.
std::string label_bytes(const SegmentCommand& command, const MeshFile& scan, const SegmentedScan& found) {
  const std::string ending = std::filesystem::path(command.output).extension().string();
  if (ending == ".json") return teeth3ds_json(found.fdi, found.jaw, scan);
  if (ending == ".ply") {
    MeshFile labelled;
    labelled.mesh = scan.mesh;
    labelled.vertex_attributes[fdi_attribute] = {AttributeType::uint8, {found.fdi.begin(), found.fdi.end()}};
    return mesh_file_bytes(command.output, labelled);
  }
  const std::vector<int> numbers = numbered_as(found.fdi, command.numbers);
  if (ending == ".vtp") return vtp_with_cell_labels(scan.mesh, triangle_labels_from_vertices(scan.mesh, numbers));
  return vtk_with_point_labels(scan.mesh, numbered_as(found.fdi, LabelNumbers::universal));
}

nlohmann::ordered_json figures_of(const SegmentedScan& found) {
  nlohmann::ordered_json teeth = nlohmann::ordered_json::array();
  for (const FoundTooth& tooth : found.teeth) {
    nlohmann::ordered_json one = tooth;
    one["middle"] = numbers(tooth.middle);
    one["vertices"] = tooth.vertices;
    teeth.push_back(std::move(one));
  }
  return {{"jaw", found.jaw == Jaw::upper ? "upper" : "lower"},
          {"jaw_confidence", found.jaw_confidence},
          {"jaw_reason", found.jaw_reason},
          {"teeth", teeth},
          {"notes", found.notes}};
}

void run(SegmentCommand& command) {
  require_ending(command.output, {".json", ".ply", ".vtp", ".vtk"}, "labels of a scan");
  const std::filesystem::path models = models_folder(command.models, command.said);
  std::vector<std::filesystem::path> inputs{command.scan};
  for (const std::filesystem::path& file : segment_model_files(models)) inputs.push_back(file);
  std::vector<std::filesystem::path> outputs = command.said.outputs();
  outputs.emplace_back(command.output);
  require_safe_outputs(inputs, outputs);
  require_new({command.output}, command.overwrite);
  command.teeth.read_into(command.options);
  const MeshFile scan = load_mesh(command.scan);
  detail_of_mesh(command.said, command.scan, scan);
  const SegmentedScan found = segment_scan(scan.mesh, SegmentModels::load(models), command.options);
  std::vector<OutputFile> files;
  if (command.said.wants_figures()) files = command.said.figures_file(figures_of(found));
  files.push_back({command.output, label_bytes(command, scan, found)});
  write_output_files(files);
  if (command.said.prints_figures()) command.said.print_figures(figures_of(found));
  if (!command.said.wants_words()) return;
  for (const std::string& note : scan.notes) fmt::print("{}\n", note);
  fmt::print("{}\n", found.jaw_reason);
  for (const FoundTooth& tooth : found.teeth)
    fmt::print("{}: {:.0f} %, {} vertices\n", tooth.fdi, 100 * tooth.confidence, tooth.vertices);
  for (const std::string& note : found.notes) fmt::print("note: {}\n", note);
  fmt::print("{} teeth; labels in {}\n", found.teeth.size(), command.output);
}

}  // namespace

void add_segment_command(CLI::App& app) {
  auto command = std::make_shared<SegmentCommand>();
  CLI::App* segment = app.add_subcommand("segment", "Find and number the teeth of a scan without labels");
  segment->add_option("SCAN", command->scan, "Scan of one jaw: .stl .ply .obj .off .vtp .vtk")->required();
  segment
      ->add_option("-o,--output", command->output,
                   "Labels: .json (Teeth3DS, FDI), .ply (attribute fdi), .vtp (cell array Label), .vtk (point array "
                   "Universal_ID)")
      ->required();
  command->teeth.add_to(*segment);
  segment
      ->add_option_function<std::string>(
          "--numbers", [command](const std::string& word) { command->numbers = read_label_numbers(word); },
          "What the numbers in a .vtp are to be; fdi if not given")
      ->check(CLI::IsMember({"fdi", "universal", "arch14", "arch16"}));
  add_unit_option(*segment, command->options.millimetres_per_unit,
                  "Unit of the scan's file: mm, cm, m, um, in, also in full and in capitals");
  segment->add_flag("--overwrite", command->overwrite, "Replace a file that is there already");
  segment->add_option("--threads", command->options.threads, "At most so many threads; 0 = all")->capture_default_str();
  add_models_option(*segment, command->models);
  command->said.add_with_figures_to(*segment);
  segment->callback([command] { run(*command); });
}

}  // namespace rhizodont::command_line
