// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace rhizodont::command_line {

// What each command asks of its outputs before it begins to work.

/// Every output has a file of its own that is none of the inputs, and a place where it can be made. Throws UsageError
/// or OutputError.
void require_safe_outputs(const std::vector<std::filesystem::path>& inputs,
                          const std::vector<std::filesystem::path>& outputs);

/// A name without one of these endings (lower case, with the dot) is a slip of the pen. Pipes and devices may have any.
/// `what`: "a picture". Throws UsageError.
void require_ending(const std::filesystem::path& output, const std::vector<std::string>& endings,
                    const std::string& what);

/// A report or a table under the name of a mesh is a slip of the pen. Throws UsageError.
void require_no_mesh_ending(const std::filesystem::path& output, const std::string& what);

/// Several files do not go to standard output. `what`: "registered teeth". Throws UsageError for the name "-".
void require_folder_name(const std::filesystem::path& folder, const std::string& what);

/// Names that the program made up itself never replace a file, unless the user said so (--overwrite). Throws
/// UsageError.
void require_new(const std::vector<std::filesystem::path>& outputs, bool overwrite);

/// Before weights and the model card beside them are exported from a training folder: `weights` has not the name of a
/// mesh, neither is a file of the folder, and an older card is replaced only if the user said so. Returns the card's
/// place. Throws UsageError or OutputError.
std::filesystem::path require_safe_export(const std::filesystem::path& weights, const std::filesystem::path& folder,
                                          bool overwrite);

/// All files in a folder and below it; none if there is no such folder.
std::vector<std::filesystem::path> files_below(const std::filesystem::path& folder);

}  // namespace rhizodont::command_line
