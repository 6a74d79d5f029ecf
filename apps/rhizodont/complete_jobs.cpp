// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "complete_jobs.hpp"

#include "command_line/output_checks.hpp"
#include "rhizodont/complete.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/io.hpp"
#include "rhizodont/output_files.hpp"
#include "rhizodont/tooth_file.hpp"

#include <fmt/format.h>

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <map>

namespace rhizodont::command_line {
namespace {

namespace fs = std::filesystem;

bool is_folder(const std::string& name) {
  std::error_code ignored;
  return name.ends_with('/') || fs::is_directory(name, ignored);
}

/// The first candidate's file has the name that the user gave, the others a number before the ending.
std::vector<fs::path> numbered(const fs::path& file, int candidates) {
  std::vector<fs::path> names{file};
  for (int i = 2; i <= candidates; ++i) {
    fs::path name = file;
    names.push_back(name.replace_filename(fmt::format("{}_{}{}", file.stem().string(), i, file.extension().string())));
  }
  return names;
}

fs::path standard_output_or(const std::string& name) { return name == "-" ? "/dev/stdout" : name; }

std::string stem_of(const std::string& crown) {
  fs::path name = fs::path(crown).filename();
  if (name.extension() == ".gz") name = name.stem();
  return crown == "-" ? "standard_input" : name.stem().string();
}

/// `made_up`: gets the names that are not the user's own, numbered ones and all in a folder.
CrownJob job_of(const CompleteFiles& files, const std::string& crown, std::vector<fs::path>& made_up) {
  CrownJob job;
  job.crown = crown;
  job.fdi = files.fdi;
  const auto names = [&](const std::string& given, const std::string& ending, int count) {
    const bool into_folder = files.crowns.size() > 1 || is_folder(given);
    const std::vector<fs::path> all =
        numbered(into_folder ? fs::path(given) / (stem_of(crown) + ending) : standard_output_or(given), count);
    made_up.insert(made_up.end(), all.begin() + (into_folder ? 0 : 1), all.end());
    return all;
  };
  job.teeth = names(files.output, "_tooth." + files.output_format, files.candidates);
  if (!files.report.empty()) job.reports = names(files.report, "_tooth.json", files.candidates);
  if (!files.confidence.empty()) job.confidence = names(files.confidence, "_confidence.ply", 1).front();
  if (!files.fdi && crown != "-" && !is_stream(crown)) {  // /dev/fd/12 is no tooth
    job.fdi = fdi_in_name(crown);
    job.fdi_from_name = job.fdi.has_value();
  }
  return job;
}

/// What several crowns give goes into a folder, also one that is still to be made. `name` may be empty.
void require_folder(const std::string& name, const char* what, const char* option) {
  static const std::vector<std::string> of_files{".ply", ".stl", ".obj", ".glb", ".off",
                                                 ".vtp", ".vtk", ".gz",  ".json"};
  if (name.empty() || is_folder(name)) return;
  if (is_stream(standard_output_or(name)))
    throw UsageError(fmt::format("Several {} cannot go to one stream: give a folder ({} FOLDER).", what, option));
  std::error_code ignored;
  const bool is_there = fs::exists(name, ignored);
  const bool named_so = std::find(of_files.begin(), of_files.end(), fs::path(name).extension()) != of_files.end();
  if (is_there || named_so)
    throw UsageError(fmt::format("{} is {} file; the {} of several crowns need a folder ({} FOLDER).", name,
                                 is_there ? "a" : "the name of a", what, option));
}

void require_counts(const CompleteFiles& files) {
  if (files.candidates < 1 || files.candidates > 9) throw UsageError("There can be 1 to 9 candidates.");
  if (files.crowns.size() > 1 && files.fdi)
    throw UsageError("--fdi is of one crown; of several, the number is taken from the file's name.");
  if (std::count(files.crowns.begin(), files.crowns.end(), "-") > 1)
    throw UsageError("Standard input (-) can be read only once.");
  if (files.candidates > 1 && (is_standard_output(standard_output_or(files.output)) || files.report == "-"))
    throw UsageError("Several candidates cannot go to standard output: give a file (-o FILE).");
  if (files.crowns.size() > 1) {
    require_folder(files.output, "teeth", "-o");
    require_folder(files.report, "reports", "--report");
    require_folder(files.confidence, "confidences", "--skirt-confidence");
  }
}

/// Two crowns whose files have one name would become one tooth.
void require_own_names(const std::vector<CrownJob>& jobs) {
  std::map<fs::path, const CrownJob*> first;
  for (const CrownJob& job : jobs) {
    const auto [same, is_new] = first.emplace(job.teeth.front(), &job);
    if (is_new) continue;
    if (same->second->crown == job.crown) throw UsageError(fmt::format("{} is given twice.", job.crown));
    throw UsageError(
        fmt::format("{} and {} would both become {}: rename one of the crowns, or complete each into a folder of its "
                    "own.",
                    same->second->crown, job.crown, job.teeth.front().string()));
  }
}

void require_name_of_tooth(const fs::path& tooth, const CompleteFiles& files) {
  const fs::path name = name_with_format(tooth, files.output_format);
  if (!name.has_extension())
    throw UsageError(
        fmt::format("{}: the name of a tooth ends in .ply, .stl, .obj or .glb; for a new folder write {}/.",
                    name.string(), name.string()));
  require_mesh_ending(name);
  if (files.output_format_given)
    require_ending(name, {"." + files.output_format}, "a tooth in the --output-format asked for");
}

}  // namespace

fs::path name_with_format(const fs::path& place, const std::string& format) {
  return is_stream(place) && !place.has_extension() ? fs::path("tooth." + format) : place;
}

std::vector<CrownJob> plan_complete(const CompleteFiles& files, const fs::path& models) {
  require_counts(files);
  std::vector<CrownJob> jobs;
  std::vector<fs::path> inputs = model_files(models), outputs, made_up;
  for (const std::string& crown : files.crowns) {
    const CrownJob& job = jobs.emplace_back(job_of(files, crown, made_up));
    inputs.emplace_back(crown == "-" ? "/dev/stdin" : crown);  // the shell may have opened a file there
    for (const fs::path& tooth : job.teeth) require_name_of_tooth(tooth, files);
    for (const fs::path& report : job.reports) require_no_mesh_ending(report, "a report");
    if (!job.confidence.empty()) require_ending(job.confidence, {".ply"}, "a crown with confidences");
    outputs.insert(outputs.end(), job.teeth.begin(), job.teeth.end());
    outputs.insert(outputs.end(), job.reports.begin(), job.reports.end());
    if (!job.confidence.empty()) outputs.push_back(job.confidence);
  }
  outputs.insert(outputs.end(), files.figures.begin(), files.figures.end());
  require_own_names(jobs);
  require_separate_files(inputs, outputs);
  require_new(made_up, files.overwrite);
  require_safe_outputs(inputs, outputs);
  if (is_standard_output(jobs.front().teeth.front()) && isatty(STDOUT_FILENO) != 0)
    throw UsageError("A mesh is not written to the terminal: give a file (-o FILE), or send the output elsewhere.");
  return jobs;
}

}  // namespace rhizodont::command_line
