// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "base/tooth_labels.hpp"
#include "io/scan_labels.hpp"
#include "rhizodont/arch.hpp"
#include "rhizodont/io.hpp"
#include "rhizodont/segment.hpp"
#include "teeth/clean_labels.hpp"

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace rhizodont {

/// Where the numbers of a scan's teeth are, and what they mean, as far as the user says so.
struct ScanLabelSource {
  std::filesystem::path labels;   ///< a Teeth3DS file; empty: not given
  std::string array;              ///< name of an array of the scan's file; empty: not given
  std::filesystem::path palette;  ///< colours and their numbers; empty: not given
  std::optional<LabelNumbers> numbers;
  std::optional<Jaw> jaw;
  std::optional<bool> first_is_patients_right;  ///< of numbers along the arch
  /// Finds the teeth of a scan that nothing tells apart, such as `segment_scan`; empty: such a scan is refused. The
  /// options have what this source and the caller know of the scan: its jaw, its unit.
  std::function<SegmentedScan(const TriangleMesh& scan, const SegmentOptions& options)> find;
};

/// A scan with its teeth, as read.
struct ScanInput {
  /// Of a folder: all crowns, one after the other, without attributes; `file_vertices` are those of each one's own
  /// file.
  MeshFile file;
  bool is_folder = false;
  std::string sha256;  ///< of the scan's file as it lies there; empty for a folder
  LabelledScan scan;
  std::vector<FoundTooth> found;   ///< where the teeth were searched for
  std::vector<std::string> notes;  ///< of reading, what the numbers were taken for, what was cleaned; a sentence each
};

/// Reads a scan and finds its labels: those that the source names, else the scan's own array, else a Teeth3DS file of
/// the same name beside it (SCAN.json), else what the source finds. A folder holds a crown a file, with the tooth's
/// number in its name: 36, UR1, id_3 (universal); other files there are passed over, and named. Labels are decided,
/// cleaned, and given as FDI numbers. Throws InputError, its vertices numbered as in the file, where there are none, or
/// as the readers do; UsageError for more than one source.
/// @param millimetres_per_unit  of the scan: what is too small for a tooth is told in mm. The scan keeps its unit
ScanInput read_scan(const std::filesystem::path& scan, const ScanLabelSource& source = {},
                    double millimetres_per_unit = 1);

/// The same of a scan that was read already, without looking at any file.
/// @param teeth3ds  the text of a Teeth3DS file; empty: the labels are the scan's own array
ScanInput scan_of_file(MeshFile file, std::string sha256, std::string_view teeth3ds = {},
                       const ScanLabelSource& source = {}, double millimetres_per_unit = 1);

/// The files that `read_scan` will read.
std::vector<std::filesystem::path> files_of_scan(const std::filesystem::path& scan, const ScanLabelSource& source);

/// The permanent or milk tooth that a file's name tells of: two digits (FDI), UR1 to LL8, id_1 to id_32 (universal).
/// Nothing if there is none or more than one.
std::optional<int> tooth_in_name(const std::filesystem::path& file);

/// Root lengths in mm by FDI number, from lines "36,14.2" or "36;14.2"; the first line may be a heading, # begins a
/// remark. Throws InputError, with the line, for anything else and for a tooth named twice.
std::map<int, double> read_root_lengths(std::string_view text);

/// The same of a file, whose name comes before what is wrong with it.
std::map<int, double> load_root_lengths(const std::filesystem::path& path);

}  // namespace rhizodont
