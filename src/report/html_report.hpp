// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "report/scan_input.hpp"
#include "rhizodont/arch.hpp"
#include "rhizodont/complete.hpp"
#include "rhizodont/io.hpp"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace rhizodont {

/// What the page of a report has beside the report itself.
struct ReportPage {
  /// What it shows in three dimensions (report/view_mesh.hpp): of a tooth "tooth" and "crown", of an arch "tooth-36",
  /// "crown-36" and so on, and "gum". Empty: nothing.
  std::map<std::string, std::string> views;
  std::string plot;                           ///< SVG; empty: none
  std::map<std::string, std::string> models;  ///< SHA-256 of the models' files by their names
};

/// The views of a tooth. To be made before the record is put into the terms of the crown's file (`refer_to_file`).
std::map<std::string, std::string> report_views(const CompletedTooth& tooth, const MeshFile& crown);

/// The views of an arch; of teeth without a root the crown alone.
std::map<std::string, std::string> report_views(const ScanInput& input, const CompletedArch& arch);

/// The hashes for `ReportPage::models`. Throws InputError for a file that cannot be read.
std::map<std::string, std::string> hashes_of(const std::vector<std::filesystem::path>& files);

/// A report (JSON: of `completion_report`, `completion_refusal_report`, `arch_report`, or figures of an evaluation) as
/// a page in one file, to be opened without a server and without anything beside it. Throws UsageError if the program
/// was built without its pages.
std::string html_report(const std::string& report, const ReportPage& page);

/// Whether a file of this name is to be a page: .html or .htm.
bool is_page_name(const std::filesystem::path& name);

/// Throws UsageError if the program was built without its pages.
void require_report_page();

}  // namespace rhizodont
