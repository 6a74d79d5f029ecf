// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/output_files.hpp"
#include "serve/job.hpp"

#include <nlohmann/json.hpp>

#include <map>
#include <string>
#include <vector>

namespace rhizodont::serve {

/// What a page shows of a tooth: numbers, root, interval, promises, warnings.
nlohmann::ordered_json tooth_summary(const CompletedTooth& tooth);

/// How a job stands, with the figures of its result or why there is none.
nlohmann::ordered_json job_json(const std::string& id, const Job& job);

/// The tooth in a format ("ply", "stl", "obj", "glb"): the bytes that the command line writes. Throws as
/// `mesh_file_bytes`.
std::string tooth_bytes(const CompletedTooth& tooth, const Scan& scan, const std::string& format);

/// The report that the command line writes with --report.
std::string report_of_tooth(const CompletedTooth& tooth, const Job& job);

/// All results of a job: a tooth in all formats that can hold it with its report, or what `rhizodont arch` writes.
std::vector<OutputFile> all_files(const Job& job);

/// The name that a browser is to save a job's file under: tooth_36.ply, tooth_36.json; of an arch its own.
std::string saved_name(const Job& job, const std::string& name);

/// One file of a job by its name: tooth.ply, tooth.stl, tooth.obj, tooth.glb, report.json, report.html, all.zip; of an
/// arch all.zip, report.html, arch.stl, arch.obj and the names that `rhizodont arch` writes. Refusal (404) for others,
/// (409) where there is no result.
/// @param model_hashes  for the pages (`ReportPage::models`)
std::string file_of(const Job& job, const std::string& name, const std::map<std::string, std::string>& model_hashes);

/// What is looked at, by name: tooth, crown, shortest, longest; of an arch tooth-FDI, crown-FDI, gum. Refusal as above.
std::string view_of(Job& job, const std::string& name);

}  // namespace rhizodont::serve
