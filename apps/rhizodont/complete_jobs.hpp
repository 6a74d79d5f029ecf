// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace rhizodont::command_line {

/// What the user said of the files of `rhizodont complete`.
struct CompleteFiles {
  std::vector<std::string> crowns;    ///< "-": standard input
  std::string output;                 ///< a file, a folder, or "-": standard output
  std::string report;                 ///< a file or, where `output` is one, a folder; may be empty
  std::string confidence;             ///< as `report`
  std::string output_format = "ply";  ///< of teeth in a folder, and where a name has no ending
  bool output_format_given = false;   ///< then a name must not say another
  std::optional<int> fdi;
  int candidates = 1;
  bool overwrite = false;
  std::vector<std::filesystem::path> figures;  ///< the file of --json, if there is to be one
};

/// One crown's part of the command.
struct CrownJob {
  std::string crown;                           ///< as given
  std::vector<std::filesystem::path> teeth;    ///< one per candidate
  std::vector<std::filesystem::path> reports;  ///< as many, or none
  std::filesystem::path confidence;            ///< may be empty
  std::optional<int> fdi;                      ///< as given, else from the file's name
  bool fdi_from_name = false;

  std::string shown_crown() const { return crown == "-" ? "standard input" : crown; }
};

/// The crowns with the places of their results. Several crowns need a folder; of names in a folder the first part is
/// the crown's file's. `models`: the folder of the networks, which nothing may be written over. Throws UsageError or
/// OutputError wherever a result would have no name that fits, no place, or would cost a file that is there.
std::vector<CrownJob> plan_complete(const CompleteFiles& files, const std::filesystem::path& models);

/// The name that says in which format a mesh goes there: the place's own, or one with the ending of `format`.
std::filesystem::path name_with_format(const std::filesystem::path& place, const std::string& format);

}  // namespace rhizodont::command_line
