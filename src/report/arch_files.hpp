// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "report/scan_input.hpp"
#include "rhizodont/arch.hpp"
#include "rhizodont/output_files.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace rhizodont {

inline constexpr int arch_report_version = 1;

struct ArchFileOptions {
  std::string tooth_format = "ply";      ///< ply, stl, obj or glb
  std::optional<std::string> scan_name;  ///< for the report; names tell of patients
  bool labels_vtp = false;               ///< also labels.vtp, the scan with the cell array `Label`
  bool labels_vtk = false;               ///< also labels.vtk, with the point array `Universal_ID`
};

/// Everything that a completed arch gives, as files of a folder:
/// tooth_FDI.FORMAT with tooth_FDI.json, its report; crown_FDI.ply, as cut from the scan, with the scan's own numbers
/// of its vertices (`scan_vertex`); arch.glb (a named node for each tooth and the gum), arch.ply (attributes fdi,
/// source, uncertainty), of a scan labels.json (Teeth3DS) and what other forms are asked for, axes.json and
/// axes.mrk.json (3D Slicer), arch.json, the report (docs/arch_report.schema.json), and arch.png, where the teeth tell
/// which way is up.
///
/// Throws InputError for milk teeth where labels.vtk is asked for: universal numbers have none.
std::vector<OutputFile> arch_files(const ScanInput& input, const CompletedArch& arch, const ArchOptions& options,
                                   const ArchFileOptions& how, const std::filesystem::path& folder);

/// The report alone (JSON), as in arch.json.
std::string arch_report(const ScanInput& input, const CompletedArch& arch, const ArchOptions& options,
                        const ArchFileOptions& how);

/// All teeth in one mesh, as in arch.ply. Throws as `require_format_holds`.
/// @param format  "ply", "stl", "obj"
std::string arch_mesh_bytes(const CompletedArch& arch, const std::string& format);

/// Refuses those teeth that their file's format cannot hold (`require_format_holds`); to be called before `arch_files`.
void refuse_what_no_file_holds(CompletedArch& arch, const ArchFileOptions& how);

/// The names that these files may have, before it is known which teeth there will be.
std::vector<std::filesystem::path> arch_file_names(const LabelledScan& scan, const ArchFileOptions& how,
                                                   const std::filesystem::path& folder);

}  // namespace rhizodont
