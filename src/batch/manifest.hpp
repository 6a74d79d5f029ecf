// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "report/scan_input.hpp"

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace rhizodont {

/// One line of a manifest: an arch or a single crown.
struct BatchCase {
  std::size_t place = 0;  ///< among the cases, from 0
  int line = 0;           ///< of the manifest, from 1
  /// What ledger and terminal call it: as given, else its number among the cases, from 1. Never a file's name.
  std::string id;
  std::string scan_as_given;
  std::filesystem::path scan;  ///< a scan, a folder of crowns, or a crown
  ScanLabelSource labels;      ///< of a scan
  bool is_crown = false;
  std::optional<int> fdi;              ///< of a crown; not there: by its file's name, else guessed
  std::map<int, double> root_lengths;  ///< of an arch: mm by FDI number
  std::optional<double> root_length;   ///< of a crown, mm
  std::optional<double> millimetres_per_unit;
};

struct BatchManifest {
  std::vector<BatchCase> cases;
  std::string sha256;  ///< of the text
};

/// Reads a table whose first line names its columns, separated by commas, semicolons or tabs (what the first line
/// holds). `scan` must be there; `labels`, `label_array`, `palette`, `labels_are`, `jaw`, `first_label`, `fdi`,
/// `root_lengths`
/// ("36=14.2 11=13.0"; of a crown also "14.2"), `unit` and `id` may be; cells may be empty. A case with `fdi` (a
/// number, or ? for one that is not known) is a single crown. Relative paths are taken from `folder`. Throws InputError
/// that names every faulty line with its column and quotes no cell: cells tell of patients.
BatchManifest read_manifest(std::string_view text, const std::filesystem::path& folder);

}  // namespace rhizodont
