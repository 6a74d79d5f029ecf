// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "command_line/output_checks.hpp"

#include "base/lower_case.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/output_files.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace rhizodont::command_line {
namespace {

namespace fs = std::filesystem;

std::string lower_ending(const fs::path& path) { return lower_case(path.extension().string()); }

}  // namespace

void require_safe_outputs(const std::vector<fs::path>& inputs, const std::vector<fs::path>& outputs) {
  require_separate_files(inputs, outputs);
  for (const fs::path& output : outputs) require_writable_place(output);
}

void require_ending(const fs::path& output, const std::vector<std::string>& endings, const std::string& what) {
  if (is_stream(output)) return;
  if (std::find(endings.begin(), endings.end(), lower_ending(output)) != endings.end()) return;
  throw UsageError(fmt::format("{}: the name of {} ends in {}.", output.string(), what, fmt::join(endings, " or ")));
}

void require_no_mesh_ending(const fs::path& output, const std::string& what) {
  static const std::vector<std::string> meshes{".ply", ".stl", ".obj", ".off", ".vtp", ".vtk", ".glb", ".gz"};
  if (std::find(meshes.begin(), meshes.end(), lower_ending(output)) != meshes.end())
    throw UsageError(fmt::format("{}: {} must not have the name of a mesh.", output.string(), what));
}

void require_folder_name(const fs::path& folder, const std::string& what) {
  if (folder != "-") return;
  throw UsageError(fmt::format(
      "Several {} cannot go to standard output: give a folder (-o FOLDER), ./- where that is its name.", what));
}

void require_new(const std::vector<fs::path>& outputs, bool overwrite) {
  if (overwrite) return;
  std::error_code ignored;
  for (const fs::path& output : outputs)
    if (fs::exists(fs::symlink_status(output, ignored)))
      throw UsageError(fmt::format(
          "{} is there already, and you did not name it yourself: move it, or say --overwrite.", output.string()));
}

std::vector<fs::path> files_below(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code failure;
  for (fs::recursive_directory_iterator entry(folder, fs::directory_options::skip_permission_denied, failure), end;
       !failure && entry != end; entry.increment(failure))
    if (entry->is_regular_file(failure)) files.push_back(entry->path());
  return files;
}

fs::path require_safe_export(const fs::path& weights, const fs::path& folder, bool overwrite) {
  fs::path card = weights;
  card.replace_extension(".md");
  require_no_mesh_ending(weights, "a weight file");
  require_new({card}, overwrite);
  require_safe_outputs(files_below(folder), {weights, card});
  return card;
}

}  // namespace rhizodont::command_line
