// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/check.hpp"
#include "rhizodont/complete.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/export.hpp"
#include "rhizodont/hash.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace rhizodont {

/// Version of the report's layout; the schema stands in docs/report.schema.json.
inline constexpr int report_version = 3;

/// What a report says of the file that was read. The name is left out unless it is given: names of files hold names of
/// patients, and the hash says as well which file it was.
struct ReportedInput {
  std::string sha256;                    ///< of the file's bytes; empty if they could not be read
  std::optional<std::string> file_name;  ///< without the folder
  std::optional<double> rounded_mm;      ///< the farthest that rounding to float moved a vertex, mm
};

/// The record's warnings and where the tooth misses promise 3, a sentence each.
RHIZODONT_EXPORT std::vector<std::string> all_warnings(const CompletionRecord& record);

/// The report on a completed tooth as JSON text; numbers of vertices stand as in the record (`refer_to_file`). Schema:
/// docs/report.schema.json.
RHIZODONT_EXPORT std::string completion_report(const CompletedTooth& tooth, const ReportedInput& input);

/// The report on a crown that was refused or came to no result: the reason and all ids concerned, as they stand in the
/// error (`in_terms_of_file`). `warnings`: what reading the file found.
RHIZODONT_EXPORT std::string completion_refusal_report(const Error& error, const CompleteOptions& options,
                                                       const ReportedInput& input,
                                                       const std::vector<std::string>& warnings = {});

/// What `check` excuses, as the report on a completed tooth lists it.
struct ExcusedByReport {
  std::vector<RepairStep> repairs;
  std::vector<int> dropped_vertices;  ///< of the crown, as not the tooth's: cap, skirt; none that a repair dropped
};

/// Reads that from a report. `file_vertices`: of the crown's MeshFile. Throws InputError if it is no report on a
/// completed tooth or the report on another file.
RHIZODONT_EXPORT ExcusedByReport excused_by_report(const std::filesystem::path& report, const std::string& crown_sha256,
                                                   const std::vector<int>& file_vertices);

/// Options of `check` that excuse that, no more; else the defaults.
RHIZODONT_EXPORT CheckOptions allowing_for(const ExcusedByReport& excused);

}  // namespace rhizodont
