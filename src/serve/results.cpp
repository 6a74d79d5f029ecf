// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "serve/results.hpp"

#include "report/arch_files.hpp"
#include "report/html_report.hpp"
#include "report/json.hpp"
#include "report/view_mesh.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/report.hpp"
#include "rhizodont/tooth_file.hpp"
#include "serve/answers.hpp"
#include "serve/zip.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>

namespace rhizodont::serve {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<const char*, 4> formats{"ply", "stl", "obj", "glb"};
constexpr std::array<const char*, 3> arch_formats{"ply", "stl", "obj"};  // a GLB holds floats by its nature: arch.glb

MeshFile crown_with_notes(const Job& job) {
  MeshFile crown = job.scan().file;
  if (const Scan& scan = job.scan(); scan.fdi_in_name && !job.request().tooth.fdi)
    crown.notes.push_back(fmt::format("Tooth {}, taken from the file's name.", *scan.fdi_in_name));
  return crown;
}

[[noreturn]] void refuse_name() { throw Refusal(404, sentence_for_status(404)); }

Json arch_json(const ArchResult& result) {
  Json teeth = Json::array(), clearances = Json::array();
  for (const ToothOfArch& tooth : result.arch.teeth) {
    Json entry{{"fdi", tooth.fdi}, {"rooted", tooth.tooth.has_value()}, {"refusal", nullptr}, {"tooth", nullptr}};
    if (tooth.tooth) {
      entry["tooth"] = tooth_summary(*tooth.tooth);
    } else {
      entry["refusal"] = tooth.refusal;
    }
    teeth.push_back(std::move(entry));
  }
  for (const ToothClearance& c : result.arch.clearances)
    if (const auto mm = c.of_roots()) clearances.push_back({{"teeth", {c.first, c.second}}, {"of_roots_mm", *mm}});
  std::vector<std::string> notes = result.input.notes;
  notes.insert(notes.end(), result.arch.notes.begin(), result.arch.notes.end());
  Json upright = nullptr;
  if (const auto& rows = result.arch.upright)
    upright = {numbers(rows->row(0)), numbers(rows->row(1)), numbers(rows->row(2))};
  return {{"teeth", teeth},
          {"searched", result.searched},
          {"found", result.input.found},
          {"clearances", clearances},
          {"upright", upright},
          {"has_gum", !result.arch.gum.triangles.empty()},
          {"notes", notes}};
}

std::vector<OutputFile> tooth_files(const ToothResult& result, const Job& job) {
  std::vector<OutputFile> files;
  for (const char* format : formats) {
    try {
      files.push_back({fmt::format("tooth.{}", format), tooth_bytes(result.tooth, job.scan(), format)});
    } catch (const Error&) {  // single precision alone, and this tooth needs more: it is there in the others
    }
  }
  files.push_back({"report.json", report_of_tooth(result.tooth, job)});
  return files;
}

const ToothOfArch& tooth_of(const ArchResult& result, const std::string& number) {
  for (const ToothOfArch& tooth : result.arch.teeth)
    if (std::to_string(tooth.fdi) == number) return tooth;
  refuse_name();
}

std::string view_of_arch(const ArchResult& result, const Scan& scan, double millimetres_per_unit,
                         const std::string& name) {
  const Point middle = middle_of(scan.file.mesh);
  if (name == "gum" && !result.arch.gum.triangles.empty())
    return plain_view(result.arch.gum, middle, millimetres_per_unit);
  if (name.starts_with("tooth-")) {
    const ToothOfArch& tooth = tooth_of(result, name.substr(6));
    if (tooth.tooth) return tooth_view(*tooth.tooth, tooth.clearance, middle);
  }
  if (name.starts_with("crown-")) {
    const ToothOfArch& tooth = tooth_of(result, name.substr(6));
    return tooth.tooth ? crown_view(tooth.crown, *tooth.tooth, middle)
                       : plain_view(tooth.crown, middle, millimetres_per_unit);
  }
  refuse_name();
}

/// The formats that hold these teeth: some are of single precision alone.
template <std::size_t count>
Json formats_that_hold(const std::array<const char*, count>& names, const std::vector<const CompletedTooth*>& teeth) {
  Json held = Json::array();
  for (const char* format : names) {
    try {
      for (const CompletedTooth* tooth : teeth) require_format_holds(*tooth, std::string("tooth.") + format);
      held.push_back(format);
    } catch (const Error&) {  // then it is not among them
    }
  }
  return held;
}

}  // namespace

Json tooth_summary(const CompletedTooth& tooth) {
  const CompletionRecord& r = tooth.record;
  Json interval = nullptr;
  if (r.root.interval)
    interval = {{"length_low_mm", r.root.interval->length_low_mm},
                {"length_high_mm", r.root.interval->length_high_mm},
                {"apex_radius_mm", r.root.interval->apex_radius_mm}};
  const Eigen::Vector3d mesial = (r.frame.mirrored ? -1 : 1) * r.frame.rotation.row(0).transpose();
  return {{"fdi", r.fdi},
          {"fdi_guessed", r.fdi_guessed},
          {"crown_triangles", r.crown.triangles},
          {"kept_triangles", r.crown.kept_triangles},
          {"crown_holds", r.promises.crown.holds},
          {"solid_holds", r.promises.solid.holds},
          {"triangles", tooth.mesh.triangles.size()},
          {"vertices", tooth.mesh.vertices.size()},
          {"new_triangles_q_avg", r.promises.new_triangles.all.value_or(QualityFigures{}).q_avg},
          {"root_length_mm", r.root.length_mm},
          {"tooth_length_mm", r.root.tooth_length_mm},
          {"interval", interval},
          {"repairs", r.repairs.size()},
          {"directions",
           {{"occlusal", numbers(r.frame.rotation.row(2))},
            {"buccal", numbers(r.frame.rotation.row(1))},
            {"along_the_arch", numbers(mesial)}}},
          {"options", Json(tooth.options)},
          {"warnings", all_warnings(r)}};
}

Json job_json(const std::string& id, const Job& job) {
  Json json{{"job", id},
            {"kind", kind_name(job.request().kind)},
            {"state", state_name(job.state())},
            {"seconds", job.seconds()},
            {"notice", "A predicted root is not the patient's anatomy. For research and visualisation only."}};
  if (const auto result = job.tooth()) {
    json["revision"] = result->revision;
    json["tooth"] = tooth_summary(result->tooth);
    for (const std::string& note : job.scan().file.notes) json["tooth"]["warnings"].push_back(note);
    json["formats"] = formats_that_hold(formats, {&result->tooth});
  }
  if (const auto result = job.arch()) {
    json["arch"] = arch_json(*result);
    std::vector<const CompletedTooth*> teeth;
    for (const ToothOfArch& tooth : result->arch.teeth)
      if (tooth.tooth) teeth.push_back(&*tooth.tooth);
    json["formats"] = teeth.empty() ? Json::array() : formats_that_hold(arch_formats, teeth);
  }
  if (const auto failure = job.failure()) json.update(failure->body);
  return json;
}

std::string tooth_bytes(const CompletedTooth& tooth, const Scan& scan, const std::string& format) {
  const std::string name = "tooth." + format;
  require_format_holds(tooth, name);
  return mesh_file_bytes(name, tooth_file(tooth, scan.file));
}

std::string report_of_tooth(const CompletedTooth& tooth, const Job& job) {
  CompletedTooth in_file = tooth;
  refer_to_file(in_file.record, crown_with_notes(job), "tooth.ply");
  return completion_report(in_file, {job.scan().sha256, std::nullopt, std::nullopt});
}

std::vector<OutputFile> all_files(const Job& job) {
  if (const auto result = job.tooth()) return tooth_files(*result, job);
  const auto result = job.arch();
  if (!result) throw Refusal(409, "There is no result.");
  CompletedArch arch = result->arch;
  const ArchFileOptions how;
  refuse_what_no_file_holds(arch, how);
  return arch_files(result->input, arch, job.request().arch, how, "arch");
}

std::string saved_name(const Job& job, const std::string& name) {
  const auto result = job.tooth();
  if (!result) return name == "all.zip" ? "arch.zip" : name == "report.html" ? "arch.html" : name;
  return fmt::format("tooth_{}{}", result->tooth.record.fdi, std::filesystem::path(name).extension().string());
}

std::string file_of(const Job& job, const std::string& name, const std::map<std::string, std::string>& model_hashes) {
  if (name == "all.zip") return zip_bytes(all_files(job));
  if (const auto result = job.tooth()) {
    if (name == "report.json") return report_of_tooth(result->tooth, job);
    if (name == "report.html")
      return html_report(report_of_tooth(result->tooth, job),
                         {report_views(result->tooth, job.scan().file), "", model_hashes});
    for (const char* format : formats)
      if (name == std::string("tooth.") + format) return tooth_bytes(result->tooth, job.scan(), format);
    refuse_name();
  }
  if (const auto result = job.arch(); result && name == "report.html")
    return html_report(arch_report(result->input, result->arch, job.request().arch, {}),
                       {report_views(result->input, result->arch), "", model_hashes});
  if (const auto result = job.arch(); result && result->arch.rooted() > 0)
    for (const char* format : arch_formats)
      if (name == std::string("arch.") + format) return arch_mesh_bytes(result->arch, format);
  for (OutputFile& file : all_files(job))
    if (file.path.filename() == name) return std::move(file.bytes);
  refuse_name();
}

std::string view_of(Job& job, const std::string& name) {
  if (const auto arch = job.arch())
    return view_of_arch(*arch, job.scan(), job.request().arch.tooth.millimetres_per_unit, name);
  const auto result = job.tooth();
  if (!result) throw Refusal(409, "There is no result.");
  const Point middle = middle_of(job.scan().file.mesh);
  if (name == "tooth") return tooth_view(result->tooth, {}, middle);
  if (name == "crown") return crown_view(job.scan().file.mesh, result->tooth, middle);
  if (name == "shortest" || name == "longest") return job.ghost(name == "longest");
  refuse_name();
}

}  // namespace rhizodont::serve
