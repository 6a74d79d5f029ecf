// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <sys/stat.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace rhizodont {

/// Where an output leads.
struct OutputPlace {
  std::filesystem::path given;       ///< as the user named it
  std::filesystem::path target;      ///< behind all links
  std::optional<struct stat> there;  ///< what stands there now, if anything
  /// The program's own open file that the name stands for (/dev/stdout, /dev/fd/3): it is written to whatever it is, as
  /// the shell may have opened it to append.
  std::optional<int> descriptor;
  std::vector<std::filesystem::path> missing_folders;  ///< to be made first, outermost first

  bool is_regular_file() const { return !descriptor && (!there || S_ISREG(there->st_mode)); }
};

/// Follows the links. Throws OutputError for a folder, a disk, a write-protected file, a circle of links, or a link
/// into a folder that is not there.
OutputPlace find_output_place(const std::filesystem::path& path);

/// Why a place cannot be written, in plain words. `error`: of errno.
std::string why_unwritable(const OutputPlace& place, int error);

/// Throws OutputError that says why in plain words, and that nothing was changed. `error`: of errno.
[[noreturn]] void throw_unwritable(const OutputPlace& place, int error);

}  // namespace rhizodont
