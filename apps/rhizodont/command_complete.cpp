// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "command_line/number_options.hpp"
#include "command_line/output_options.hpp"
#include "command_line/progress_line.hpp"
#include "command_line/terminal.hpp"
#include "command_line/words.hpp"
#include "commands.hpp"
#include "complete_jobs.hpp"
#include "dropped_text.hpp"
#include "mesh_detail.hpp"
#include "models_option.hpp"
#include "report/html_report.hpp"
#include "rhizodont/complete.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/io.hpp"
#include "rhizodont/output_files.hpp"
#include "rhizodont/report.hpp"
#include "rhizodont/tooth_file.hpp"
#include "skirt_option.hpp"
#include "unit_option.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace rhizodont::command_line {
namespace {

using Json = nlohmann::ordered_json;

struct CompleteCommand {
  CompleteFiles files;
  std::string format;
  std::string models;
  std::string skirt = "keep";
  bool as_float = false;
  bool name_in_report = false;
  OutputOptions said;
  CompleteOptions options;
};

const std::map<std::string, CapHandling> cap_names{{"drop", CapHandling::drop}, {"keep", CapHandling::keep}};

/// Names the stage at work.
ProgressCallback progress_on(ProgressLine& line, const std::string& before) {
  if (!line.is_shown()) return {};
  return [&line, before](std::string_view stage) { line.say(fmt::format("{}{} ...", before, stage)); };
}

void print_summary(std::FILE* out, const CompletedTooth& tooth, const std::string& output) {
  const CompletionRecord& r = tooth.record;
  double seconds = 0;
  for (const StageRecord& stage : r.stages) seconds += stage.seconds;
  fmt::print(
      out,
      "{}: tooth {}{}, {} of {} crown triangles kept bit for bit, root {:.1f} mm, new triangles Q {:.3f}, {:.2f} s\n",
      output, r.fdi, r.fdi_guessed ? " (guessed)" : "", r.crown.kept_triangles, r.crown.triangles, r.root.length_mm,
      r.promises.new_triangles.all.value_or(QualityFigures{}).q_avg, seconds);
  if (const auto& interval = r.root.interval)
    fmt::print(out, "  root length with 80 % probability {:.1f} to {:.1f} mm, apex within {:.1f} mm\n",
               interval->length_low_mm, interval->length_high_mm, interval->apex_radius_mm);
  if (const auto& likeness = r.likeness)
    fmt::print(out, "  like a {}: {:.0f} %, {:.2f} mm from its mean crown; next {} ({:.0f} %) and {} ({:.0f} %)\n",
               likeness->said.fdi, 100 * likeness->said.probability, likeness->said.distance_mm, likeness->next[0].fdi,
               100 * likeness->next[0].probability, likeness->next[1].fdi, 100 * likeness->next[1].probability);
  if (const std::string dropped = dropped_text(r.crown.dropped_vertices); !dropped.empty())
    fmt::print(out, "  {}\n", dropped);
  for (const RepairStep& step : r.repairs)
    fmt::print(out, "  repaired: {} ({} vertices, {} triangles)\n", action_text(step), step.vertices.size(),
               step.triangles.size());
  for (const std::string& warning : all_warnings(r))
    fmt::print(out, "  {} {}\n", coloured(out, TextColour::yellow, "note:"), warning);
}

/// All that the crowns of a command have in common.
class Completion {
 public:
  explicit Completion(const CompleteCommand& command)
      : command_(command),
        models_folder_(models_folder(command.models, command.said)),
        jobs_(plan_complete(command.files, models_folder_)) {
    if (!command.files.confidence.empty() && !skirt_threshold(command.skirt))
      throw UsageError("A confidence is there only where a skirt is looked for (--skirt auto).");
    for (const CrownJob& job : jobs_)
      for (const auto& report : job.reports) has_pages_ = has_pages_ || is_page_name(report);
    if (has_pages_) require_report_page();
    for (const CrownJob& job : jobs_)
      for (const auto* names : {&job.teeth, &job.reports})
        for (const auto& name : *names)
          if (is_standard_output(name)) words_ = stderr;
    if (is_standard_output(jobs_.front().confidence)) words_ = stderr;
    if (words_ == stderr && command.said.prints_figures())
      throw UsageError("Figures (--json) would be mixed with what goes to standard output: give them a file.");
  }

  /// Completes them all; one that fails does not stop the others. The exit code of all together: the largest of theirs,
  /// but where some have teeth and others none.
  int run() {
    models_ = CompletionModels::load(models_folder_);  // not in a crown's name: no report is to say it was refused
    if (has_pages_) model_hashes_ = hashes_of(model_files(models_folder_));  // once for the pages of all crowns
    int worst = 0;
    std::size_t completed = 0;
    for (std::size_t i = 0; i < jobs_.size(); ++i) {
      const int code = complete_and_say(jobs_[i], i);
      worst = std::max(worst, code);
      completed += code == 0;
    }
    if (jobs_.size() > 1) write_output_files(command_.said.figures_file(figures()));
    command_.said.print_figures(figures());
    if (jobs_.size() > 1 && command_.said.wants_words())
      fmt::print(words_, "{} of {} crowns completed\n", completed, jobs_.size());
    const bool is_partial = completed > 0 && completed < jobs_.size() &&
                            worst != static_cast<int>(ErrorCode::internal) &&
                            worst != static_cast<int>(ErrorCode::unwritable);
    return is_partial ? static_cast<int>(ErrorCode::partial) : worst;
  }

 private:
  /// What is known of a crown when it is given up.
  struct Attempt {
    CompleteOptions options;
    ReportedInput input;
    std::vector<std::string> notes;  // of reading
    bool is_read = false;
  };

  int complete_and_say(const CrownJob& job, std::size_t place) {
    Attempt attempt;
    if (command_.name_in_report && job.crown != "-")
      attempt.input.file_name = std::filesystem::path(job.crown).filename().string();
    attempt.options = command_.options;
    attempt.options.fdi = job.fdi;
    attempt.options.skirt = skirt_threshold(command_.skirt);
    try {
      complete_one(job, place, attempt);
      return 0;
    } catch (const Error& error) {
      const bool is_refusal = error.code() == ErrorCode::unusable_input || error.code() == ErrorCode::no_result;
      const bool reported = !job.reports.empty() && is_refusal;
      say(error_line(error, reported ? "see " + job.reports.front().string() : ""), job, !attempt.is_read);
      const int code = static_cast<int>(error.code());
      const std::string report =
          is_refusal ? completion_refusal_report(error, attempt.options, attempt.input, attempt.notes) : "";
      add_figures(job, code, Json::array(), is_refusal ? Json::parse(report) : Json(nullptr));
      return is_refusal ? std::max(code, write_refusal(report, job)) : code;
    } catch (const std::exception& fault) {  // the other crowns may do
      if (std::ferror(stdout) != 0) throw;   // but nothing more can be said
      say(fault_line(fault), job, !attempt.is_read);
      add_figures(job, static_cast<int>(ErrorCode::internal), Json::array(), nullptr);
      return static_cast<int>(ErrorCode::internal);
    }
  }

  void complete_one(const CrownJob& job, std::size_t place, Attempt& attempt) {
    MeshFile crown = read_crown(job, attempt.input);
    attempt.is_read = true;
    if (job.fdi_from_name) crown.notes.push_back(fmt::format("Tooth {}, taken from the file's name.", *job.fdi));
    attempt.notes = crown.notes;
    const CompleteOptions& options = attempt.options;
    ReportedInput& input = attempt.input;
    if (command_.as_float)
      input.rounded_mm = round_coordinates(crown, options.millimetres_per_unit);
    else
      require_format_holds_crown(crown, job.shown_crown(), job.teeth.front(),
                                 name_with_format(job.teeth.front(), command_.files.output_format));
    const std::string before =
        jobs_.size() > 1 ? fmt::format("{} ({} of {}): ", job.shown_crown(), place + 1, jobs_.size()) : "";
    detail_of_mesh(command_.said, job.shown_crown(), crown);
    ProgressLine line(command_.said);
    std::vector<CompletedTooth> candidates;
    try {
      candidates =
          complete_candidates(crown.mesh, *models_, command_.files.candidates, options, progress_on(line, before));
    } catch (const InputError& error) {
      throw in_terms_of_file(error, crown);
    } catch (const NoResultError& error) {
      throw in_terms_of_file(error, crown);
    }
    line.clear();
    for (CompletedTooth& tooth : candidates) warn_of_rounding(input, tooth.record);
    for (std::size_t i = 0; i < candidates.size(); ++i)
      require_format_holds(candidates[i], name_with_format(job.teeth[i], command_.files.output_format));
    write_results(job, crown, candidates, input);
    for (const CompletedTooth& tooth : candidates)
      for (const StageRecord& stage : tooth.record.stages)
        command_.said.detail(
            fmt::format("  {:<36}{:7.3f} s, {:.0f} MB", stage.name, stage.seconds, stage.peak_memory_mb));
    if (command_.said.wants_words()) print_results(job, candidates);
  }

  MeshFile read_crown(const CrownJob& job, ReportedInput& input) const {
    const std::string bytes = job.crown == "-" ? read_standard_input() : read_file_bytes(job.crown);
    input.sha256 = sha256_of_bytes(bytes);
    return read_mesh(bytes, command_.format.empty() ? job.crown : command_.format);
  }

  /// Their records refer to the crown's file from then on.
  void write_results(const CrownJob& job, const MeshFile& crown, std::vector<CompletedTooth>& candidates,
                     const ReportedInput& input) {
    std::vector<OutputFile> results;
    Json teeth = Json::array();
    const auto add_mesh = [&](const std::filesystem::path& path, const MeshFile& mesh) {
      results.push_back({path, mesh_file_bytes(name_with_format(path, command_.files.output_format), mesh)});
    };
    if (!job.confidence.empty()) add_mesh(job.confidence, confidence_file(crown, candidates.front().record));
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      add_mesh(job.teeth[i], tooth_file(candidates[i], crown));
      std::map<std::string, std::string> views;
      if (!job.reports.empty() && is_page_name(job.reports[i])) views = report_views(candidates[i], crown);
      refer_to_file(candidates[i].record, crown, name_with_format(job.teeth[i], command_.files.output_format));
      const std::string report =
          job.reports.empty() && !command_.said.wants_figures() ? "" : completion_report(candidates[i], input);
      if (!job.reports.empty()) results.push_back({job.reports[i], as_named(job.reports[i], report, std::move(views))});
      if (command_.said.wants_figures())
        teeth.push_back({{"tooth", job.teeth[i].string()}, {"report", Json::parse(report)}});
    }
    add_figures(job, 0, std::move(teeth), nullptr);
    add_figures_of_only_crown(results);
    try {
      write_output_files(results);
    } catch (...) {
      figures_.erase(figures_.size() - 1);  // there is no tooth after all
      throw;
    }
  }

  void print_results(const CrownJob& job, const std::vector<CompletedTooth>& candidates) const {
    for (std::size_t i = 0; i < candidates.size(); ++i) print_summary(words_, candidates[i], job.teeth[i].string());
  }

  /// The report as JSON, or as a page where its name says so.
  std::string as_named(const std::filesystem::path& name, const std::string& report,
                       std::map<std::string, std::string> views) const {
    if (!is_page_name(name)) return report;
    return html_report(report, {std::move(views), "", model_hashes_});
  }

  /// The crown's name goes to the screen alone: reports are passed on, and names tell of patients.
  void say(const std::string& line, const CrownJob& job, bool is_about_file) const {
    const bool needs_name = (is_about_file || jobs_.size() > 1) && line.find(job.shown_crown()) == std::string::npos;
    print_error("rhizodont", (needs_name ? job.shown_crown() + ": " : "") + line);
  }

  /// `teeth`: each with its report; `refusal`: the report on a crown without any, or null.
  void add_figures(const CrownJob& job, int code, Json teeth, Json refusal) {
    figures_.push_back(
        {{"crown", job.crown}, {"exit_code", code}, {"teeth", std::move(teeth)}, {"refusal", std::move(refusal)}});
  }

  Json figures() const { return {{"crowns", figures_}}; }

  /// The file of figures appears with the crown's results; of several crowns it comes after all of them.
  void add_figures_of_only_crown(std::vector<OutputFile>& results) const {
    if (jobs_.size() > 1) return;
    for (OutputFile& file : command_.said.figures_file(figures())) results.push_back(std::move(file));
  }

  /// The report and the figures say of a crown without a tooth why and where.
  int write_refusal(const std::string& report, const CrownJob& job) const {
    try {
      std::vector<OutputFile> results;
      if (!job.reports.empty()) results.push_back({job.reports.front(), as_named(job.reports.front(), report, {})});
      add_figures_of_only_crown(results);
      write_output_files(results);
      return 0;
    } catch (const Error& unwritable) {
      say(error_line(unwritable), job, false);
      return static_cast<int>(unwritable.code());
    }
  }

  const CompleteCommand& command_;
  std::filesystem::path models_folder_;
  std::vector<CrownJob> jobs_;
  std::optional<CompletionModels> models_;
  bool has_pages_ = false;
  Json figures_ = Json::array();                     // of the crowns so far
  std::map<std::string, std::string> model_hashes_;  // of the pages
  std::FILE* words_ = stdout;                        // what is said to the user, so that it does not get into a mesh
};

void run(const CompleteCommand& command) {
  const int code = Completion(command).run();
  if (code != 0) exit_with(code);
}

void add_file_options(CLI::App& complete, CompleteCommand& command) {
  CompleteFiles& files = command.files;
  complete
      .add_option("CROWN", files.crowns,
                  "Crown meshes: .stl .ply .obj .off .vtp .vtk, also .gz; - is standard input. Several need a folder "
                  "(-o FOLDER); their "
                  "numbers are taken from the files' names")
      ->required();
  complete
      .add_option("-o,--output", files.output,
                  "Where the tooth goes: .ply .stl .obj .glb, a folder, or - for standard output")
      ->required();
  complete
      .add_option("--format", command.format,
                  "Format of CROWN where neither contents nor name tell: stl, ply, obj, off, vtp, vtk")
      ->check(CLI::IsMember({"stl", "ply", "obj", "off", "vtp", "vtk"}, CLI::ignore_case));
  complete.add_option("--output-format", files.output_format, "Format of teeth in a folder or on standard output")
      ->check(CLI::IsMember({"ply", "stl", "obj", "glb"}))
      ->each([&files](const std::string&) { files.output_format_given = true; })
      ->capture_default_str();
  complete.add_flag("--as-float", command.as_float,
                    "Round the crown to float, which is all that STL and GLB can hold; the report says by how much");
  complete.add_option(
      "--fdi", files.fdi,
      "FDI number of the tooth, 11-48; without it the one in the file's name, else the type is guessed");
  complete.add_option(
      "--report", files.report,
      "Write the report to this file or folder, also if the crown is refused: JSON, or a page to look at (.html)");
  complete.add_flag("--name-in-report", command.name_in_report,
                    "The report names the crown's file; else it holds its hash alone, for names tell of patients");
  complete.add_option("--skirt-confidence", files.confidence,
                      "Write the crown with the confidence of each vertex to this file (.ply)");
  complete
      .add_option("--candidates", files.candidates,
                  "Number of teeth: the expected one, then others (OUTPUT_2, ...) over the interval of root length")
      ->capture_default_str();
  complete.add_flag("--overwrite", files.overwrite,
                    "Replace files also where you did not name them yourself: in a folder, or OUTPUT_2, ...");
}

void add_root_options(CLI::App& complete, RootSteering& steering) {
  complete.add_option("--root-length", steering.length_mm,
                      "Length of the root in mm, such as measured on an X-ray: lowest point of the crown to the apex");
  complete.add_option("--root-tip", steering.tip_degrees, "Turn the root, degrees; positive: apex towards distal");
  complete.add_option("--root-torque", steering.torque_degrees,
                      "Turn the root, degrees; positive: apex towards tongue or palate");
  complete.add_option("--root-bend", steering.bend_degrees,
                      "Bend the root's lower half, degrees; positive: apex towards distal");
}

}  // namespace

void add_complete_command(CLI::App& app) {
  auto command = std::make_shared<CompleteCommand>();
  CLI::App* complete = app.add_subcommand("complete", "Whole teeth with roots from scanned crowns");
  add_file_options(*complete, *command);
  complete->add_option("--e", command->options.e, "Side of the lattice in mm, 0.2 to 2; new edges are about half of it")
      ->capture_default_str();
  complete->add_option("--cap", command->options.cap, "A cap that closes the crown's base: drop, keep")
      ->transform(CLI::CheckedTransformer(cap_names, CLI::ignore_case))
      ->default_str("drop");
  complete
      ->add_option("--skirt", command->skirt,
                   "Gum and webs around the crown: keep, auto (drop), or drop below this CONFIDENCE of being tooth")
      ->type_name("TEXT:{keep,auto,...}")
      ->capture_default_str();
  complete->add_flag("--repair", command->options.repair,
                     "Mend a defective crown first: merges, drops and turns, each listed in the report");
  add_unit_option(*complete, command->options.millimetres_per_unit,
                  "Unit of the crown's file: mm, cm, m, um, in, also in full and in capitals");
  complete->add_option("--transition", command->options.transition,
                       "Width in mm of the smoothed band beside the crown, 0 to 5; chosen if not given");
  add_root_options(*complete, command->options.steering);
  complete->add_option("--threads", command->options.threads, "At most so many threads; 0 = all")
      ->capture_default_str();
  add_models_option(*complete, command->models);
  command->said.add_with_figures_to(*complete);
  complete->callback([command] {
    command->files.figures = command->said.outputs();
    run(*command);
  });
}

}  // namespace rhizodont::command_line
