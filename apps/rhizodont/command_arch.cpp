// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "arch/arch_options.hpp"
#include "command_line/number_options.hpp"
#include "command_line/output_checks.hpp"
#include "command_line/output_options.hpp"
#include "command_line/progress_line.hpp"
#include "commands.hpp"
#include "dropped_text.hpp"
#include "models_option.hpp"
#include "report/arch_files.hpp"
#include "report/html_report.hpp"
#include "report/scan_input.hpp"
#include "rhizodont/arch.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/output_files.hpp"
#include "rhizodont/report.hpp"
#include "rhizodont/segment.hpp"
#include "teeth/fdi.hpp"
#include "teeth/label_numbers.hpp"
#include "unit_option.hpp"

#include <fmt/core.h>

#include <charconv>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace rhizodont::command_line {
namespace {

struct ArchCommand {
  std::string scan, output, models, lengths_file, report;
  ScanLabelSource source;
  std::vector<std::string> lengths;  // "36=14.2"
  ArchFileOptions files;
  ArchOptions options;
  bool overwrite = false, name_in_report = false;
  OutputOptions said;
};

void add_length(const std::string& text, std::map<int, double>& lengths) {
  const std::size_t at = text.find('=');
  const auto fdi = read_fdi(text.substr(0, at));
  double mm = 0;
  const char *begin = text.data() + (at == std::string::npos ? text.size() : at + 1), *end = text.data() + text.size();
  const auto [stop, failure] = std::from_chars(begin, end, mm);
  if (!fdi || failure != std::errc() || stop != end)
    throw UsageError(
        fmt::format("--root-length takes teeth with their lengths in mm, such as 36=14.2, not '{}'.", text));
  if (!lengths.emplace(*fdi, mm).second) throw UsageError(fmt::format("Tooth {} has two root lengths.", *fdi));
}

ArchProgress progress_on(ProgressLine& line) {
  if (!line.is_shown()) return {};
  return [&line](int done, int teeth, int fdi) { line.say(fmt::format("{} of {} teeth: {}", done, teeth, fdi)); };
}

void print_summary(const CompletedArch& arch) {
  for (const ToothOfArch& tooth : arch.teeth) {
    if (!tooth.tooth) {
      fmt::print("{}: no root: {}\n", tooth.fdi, tooth.refusal);
      continue;
    }
    const CompletionRecord& r = tooth.tooth->record;
    fmt::print("{}: root {:.1f} mm", tooth.fdi, r.root.length_mm);
    if (r.root.interval)
      fmt::print(" ({:.1f} to {:.1f} with 80 % probability)", r.root.interval->length_low_mm,
                 r.root.interval->length_high_mm);
    fmt::print(", {} of {} crown triangles kept\n", r.crown.kept_triangles, r.crown.triangles);
    if (const std::string dropped = dropped_text(r.crown.dropped_vertices); !dropped.empty())
      fmt::print("  {}\n", dropped);
    for (const std::string& warning : all_warnings(r)) fmt::print("  note: {}\n", warning);
  }
}

/// The report as a page, where one was asked for; after the folder's files, which it may lie among.
void add_page(const ArchCommand& command, const ScanInput& input, const CompletedArch& arch,
              const std::vector<std::filesystem::path>& weights, std::vector<OutputFile>& files) {
  if (command.report.empty()) return;
  files.push_back({command.report, html_report(arch_report(input, arch, command.options, command.files),
                                               {report_views(input, arch), "", hashes_of(weights)})});
}

/// What arch.json has, where figures were asked for.
nlohmann::ordered_json figures_of(const ArchCommand& command, const ScanInput& input, const CompletedArch& arch) {
  if (!command.said.wants_figures()) return nullptr;
  return nlohmann::ordered_json::parse(arch_report(input, arch, command.options, command.files));
}

/// Before hours of work.
void require_page(const std::string& report) {
  if (report.empty()) return;
  if (!is_page_name(report))
    throw UsageError("--report is a page to look at: give it a name in .html. The folder has its JSON as arch.json.");
  require_report_page();
}

void run(ArchCommand& command) {
  require_page(command.report);
  require_folder_name(command.output, "teeth");
  for (const std::string& length : command.lengths) add_length(length, command.options.root_lengths);
  const std::filesystem::path models = models_folder(command.models, command.said);
  std::vector<std::filesystem::path> inputs = files_of_scan(command.scan, command.source);
  if (!command.lengths_file.empty()) {
    inputs.emplace_back(command.lengths_file);
    for (const auto& [fdi, mm] : load_root_lengths(command.lengths_file))
      if (!command.options.root_lengths.emplace(fdi, mm).second)
        throw UsageError(fmt::format("Tooth {} has two root lengths.", fdi));
  }
  std::vector<std::filesystem::path> weights = model_files(models);
  if (SegmentModels::are_in(models)) {
    for (const std::filesystem::path& file : segment_model_files(models)) weights.push_back(file);
    command.source.find = [&](const TriangleMesh& scan, SegmentOptions search) {
      search.threads = command.options.tooth.threads;
      return segment_scan(scan, SegmentModels::load(models), search);
    };
  }
  inputs.insert(inputs.end(), weights.begin(), weights.end());
  const CompletionModels loaded = CompletionModels::load(models);
  require_models_of_arch(loaded, command.options);  // before minutes of search for teeth
  ScanInput input = read_scan(command.scan, command.source, command.options.tooth.millimetres_per_unit);
  std::vector<std::filesystem::path> names = arch_file_names(input.scan, command.files, command.output);
  if (!command.report.empty()) names.emplace_back(command.report);
  std::vector<std::filesystem::path> outputs = command.said.outputs();
  outputs.insert(outputs.end(), names.begin(), names.end());
  require_safe_outputs(inputs, outputs);
  require_new(names, command.overwrite);
  if (command.said.wants_words())
    for (const std::string& note : input.notes) fmt::print("{}\n", note);
  std::fflush(stdout);  // the work takes a while
  if (command.name_in_report && !input.sha256.empty())
    command.files.scan_name = std::filesystem::path(command.scan).filename().string();
  ProgressLine line(command.said);
  CompletedArch arch = complete_arch(input.scan, loaded, command.options, progress_on(line));
  line.clear();
  refuse_what_no_file_holds(arch, command.files);
  std::vector<OutputFile> files = arch_files(input, arch, command.options, command.files, command.output);
  add_page(command, input, arch, weights, files);
  const nlohmann::ordered_json figures = figures_of(command, input, arch);
  for (OutputFile& file : command.said.figures_file(figures)) files.push_back(std::move(file));
  write_output_files(files);
  command.said.print_figures(figures);
  if (command.said.wants_words()) {
    print_summary(arch);
    for (const ToothClearance& c : arch.clearances)
      if (const auto mm = c.of_roots(); mm && *mm < 0)
        fmt::print("{} and {} run {:.2f} mm into each other at a root\n", c.first, c.second, -*mm);
    for (const std::string& note : arch.notes) fmt::print("{}\n", note);
    fmt::print("{} of {} teeth have roots; all is in {}\n", arch.rooted(), arch.teeth.size(), command.output);
  }
  if (arch.rooted() == 0) exit_with(static_cast<int>(ErrorCode::no_result));
  if (arch.rooted() < static_cast<int>(arch.teeth.size())) exit_with(static_cast<int>(ErrorCode::partial));
}

void add_label_options(CLI::App& arch, const std::shared_ptr<ArchCommand>& command) {
  arch.add_option("--labels", command->source.labels, "File with a number for each vertex (JSON of Teeth3DS)");
  arch.add_option("--label-array", command->source.array, "Name of the scan's array of numbers, per point or cell");
  arch.add_option("--palette", command->source.palette,
                  "What the scan's colours stand for: lines 'RRGGBB number', or JSON");
  arch.add_option_function<std::string>(
          "--labels-are", [command](const std::string& word) { command->source.numbers = read_label_numbers(word); },
          "What the numbers are; decided by themselves if not given")
      ->check(CLI::IsMember({"fdi", "universal", "arch14", "arch16"}));
  arch.add_option_function<std::string>(
          "--jaw",
          [command](const std::string& word) { command->source.jaw = word == "upper" ? Jaw::upper : Jaw::lower; },
          "upper or lower, where numbers run along the arch or teeth are to be found")
      ->check(CLI::IsMember({"upper", "lower"}));
  arch.add_option_function<std::string>(
          "--first-label",
          [command](const std::string& word) { command->source.first_is_patients_right = word == "right"; },
          "The patient's side at which numbers along the arch begin: right or left; by the scan's form if not given")
      ->check(CLI::IsMember({"right", "left"}));
  arch.add_flag("--labels-vtp", command->files.labels_vtp, "Write the labels as labels.vtp, too (cells, FDI numbers)");
  arch.add_flag("--labels-vtk", command->files.labels_vtk,
                "Write the labels as labels.vtk, too (points, Universal_ID, 33 is gum)");
}

}  // namespace

void add_arch_command(CLI::App& app) {
  auto command = std::make_shared<ArchCommand>();
  CLI::App* arch = app.add_subcommand("arch", "Every tooth of a scan with its root");
  arch->add_option("SCAN", command->scan,
                   "Scan, its teeth labelled or to be found, or a folder of crowns with their numbers in their names")
      ->required();
  arch->add_option("-o,--output", command->output, "Folder for the teeth, reports, scene and picture")->required();
  add_label_options(*arch, command);
  arch->add_option("--root-length", command->lengths,
                   "Lengths of roots measured on X-rays, in mm: 36=14.2 11=13.0; the other teeth follow");
  arch->add_option("--root-lengths", command->lengths_file, "The same from a file with lines 36,14.2");
  CLI::Option* resolve = arch->add_flag(
      "--resolve-collisions", command->options.resolve_collisions,
      "Turn, bend or shorten roots that come too near to other teeth, by the least change; new surface that lies in a "
      "neighbour gives way");
  arch->add_option("--clearance", command->options.clearance_mm, "What they are to keep, mm, 0 to 3")
      ->needs(resolve)
      ->capture_default_str();
  arch->add_option("--e", command->options.tooth.e,
                   "Side of the lattice in mm, 0.2 to 2; new edges are about half of it")
      ->capture_default_str();
  arch->add_option("--output-format", command->files.tooth_format, "Format of the teeth")
      ->check(CLI::IsMember({"ply", "stl", "obj", "glb"}))
      ->capture_default_str();
  add_unit_option(*arch, command->options.tooth.millimetres_per_unit,
                  "Unit of the scan's file: mm, cm, m, um, in, also in full and in capitals");
  arch->add_option("--report", command->report, "Write a page to look at, too: all teeth in one file (.html)");
  arch->add_flag("--name-in-report", command->name_in_report,
                 "The report names the scan's file; else it holds its hash alone, for names tell of patients");
  arch->add_flag("--overwrite", command->overwrite, "Replace files that are in the folder already");
  arch->add_option("--threads", command->options.tooth.threads, "At most so many threads; 0 = all")
      ->capture_default_str();
  add_models_option(*arch, command->models);
  command->said.add_with_figures_to(*arch);
  arch->callback([command] { run(*command); });
}

}  // namespace rhizodont::command_line
