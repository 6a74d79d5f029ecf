// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "batch/batch_models.hpp"
#include "batch/manifest.hpp"
#include "batch/shard.hpp"
#include "report/arch_files.hpp"
#include "rhizodont/arch.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace rhizodont {

/// What all cases of a batch have in common. Only these and a case's own line have a say in its results.
struct CaseOptions {
  ArchOptions arch;       ///< of scans; the unit, lengths and threads are a case's or the batch's to say
  CompleteOptions crown;  ///< of single crowns, likewise
  std::string tooth_format = "ply";
  bool labels_vtp = false, labels_vtk = false;  ///< of arches also the labels in these forms
  bool keep_names = false;                      ///< names of files may stand in results and in what is said
};

/// What a case's results are known by.
struct CaseKey {
  std::string key;          ///< 32 hexadecimal digits
  std::string scan_sha256;  ///< of the scan's bytes; empty for a folder of crowns
};

/// A hash of all that the results depend on: the bytes of the case's files, their formats by name and the teeth in
/// their names, the case's line, options, models, and the program's version; neither names nor places. Throws
/// InputError if a file cannot be read.
CaseKey key_of_case(const BatchCase& one, const CaseOptions& options, const BatchModels& models);

/// The options' part of it, for crowns or scans as `one` is.
std::string text_of_options(const BatchCase& one, const CaseOptions& options);

/// By which readers take a file's format, as it is written: ".stl", of a packed one ".stl.gz".
std::string ending_of(const std::filesystem::path& file);

/// All files that the case is read from, and its scan or folder first.
std::vector<std::filesystem::path> files_of_case(const BatchCase& one);

}  // namespace rhizodont
