// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "rhizodont/report.hpp"
#include "rhizodont/version.hpp"

#include "pipeline/report_parts.hpp"
#include "report/json.hpp"
#include "rhizodont/error.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <map>

namespace rhizodont {
namespace {

using Json = nlohmann::ordered_json;

Json rows(const Eigen::Matrix3d& m) {
  Json json = Json::array();
  for (int r = 0; r < 3; ++r) json.push_back(numbers(m.row(r)));
  return json;
}

Json crown_json(const CompletionRecord& record) {
  std::map<int, std::string> repaired;
  for (const RepairStep& step : record.repairs)
    for (const int v : step.vertices) repaired.emplace(v, action_text(step));
  std::map<std::string, std::vector<int>> by_reason;
  for (const DroppedCrownVertex& d : record.crown.dropped_vertices) {
    const auto repair = d.reason == DropReason::repair ? repaired.find(d.vertex) : repaired.end();
    by_reason[repair == repaired.end() ? std::string(reason_text(d.reason)) : repair->second].push_back(d.vertex);
  }
  Json dropped = Json::object();
  for (const auto& [reason, vertices] : by_reason) dropped[reason] = vertices;
  return {{"triangles", record.crown.triangles},
          {"kept_triangles", record.crown.kept_triangles},
          {"cap_dropped", record.crown.cap_dropped},
          {"dropped_vertices_by_reason", dropped},
          {"kept_vertices", record.crown.kept_vertices}};
}

Json repairs_json(const std::vector<RepairStep>& repairs) {
  Json json = Json::array();
  for (const RepairStep& step : repairs) {
    json.push_back({{"action", action_text(step)}, {"vertices", step.vertices}, {"triangles", step.triangles}});
    if (!step.merged_into.empty()) json.back()["merged_into"] = step.merged_into;
  }
  return json;
}

Json likeness_json(const std::optional<CrownLikeness>& likeness) {
  if (!likeness) return nullptr;
  const auto tooth = [](const ToothLikeness& t) {
    return Json{{"fdi", t.fdi}, {"probability", t.probability}, {"distance_mm", t.distance_mm}};
  };
  constexpr std::array<const char*, 3> verdicts{"fits", "other tooth", "unlike"};
  return {{"verdict", verdicts[static_cast<std::size_t>(likeness->verdict)]},
          {"said", tooth(likeness->said)},
          {"next", {tooth(likeness->next[0]), tooth(likeness->next[1])}},
          {"seen", likeness->seen},
          {"explained", likeness->explained},
          {"unlike_probability", likeness->unlike_probability}};
}

Json frame_json(const CompletionRecord& record) {
  return {{"growth_axis", numbers(record.frame.growth_axis)},
          {"rotation", rows(record.frame.rotation)},
          {"centre_mm", numbers(record.frame.centre)},
          {"mirrored", record.frame.mirrored},
          {"distance_to_mean_crown_mm", record.frame.distance_to_mean_crown_mm}};
}

Json root_json(const CompletionRecord& record) {
  constexpr std::array<const char*, 3> sources{"network", "network, laid anew", "mean tooth"};
  Json json{{"source", sources[static_cast<std::size_t>(record.root.source)]},
            {"length_mm", record.root.length_mm},
            {"tooth_length_mm", record.root.tooth_length_mm},
            {"apex_expected_distance_mm", record.root.apex_expected_distance_mm},
            {"interval", nullptr}};
  if (const auto& interval = record.root.interval)
    json["interval"] = {{"probability", 0.8},
                        {"length_low_mm", interval->length_low_mm},
                        {"length_high_mm", interval->length_high_mm},
                        {"apex_radius_mm", interval->apex_radius_mm}};
  return json;
}

Json joining_json(const CompletionRecord& record) {
  return {{"guiding_vertices", record.joining.guiding_vertices},
          {"crown_to_guiding_surface_mean_mm", record.joining.guiding_distance_mean_mm},
          {"crown_to_guiding_surface_max_mm", record.joining.guiding_distance_max_mm},
          {"steiner_points", record.joining.steiner_points},
          {"crown_triangles_from_dual", record.joining.crown_triangles_direct},
          {"crown_triangles_restored", record.joining.crown_triangles_restored},
          {"non_delaunay_edges_left", record.joining.non_delaunay_edges_left},
          {"root_sites", record.joining.root_sites},
          {"sites_without_cell", record.joining.sites_without_cell},
          {"triangles_filled", record.joining.triangles_filled},
          {"holes_filled", record.joining.holes_filled},
          {"remeshing_operations", record.joining.remeshing_operations},
          {"border_sharpest_notch_degrees", record.joining.sharpest_notch_degrees},
          {"transition_vertices", record.joining.transition_vertices},
          {"transition_width_mm", record.joining.transition_width_mm},
          {"transition_largest_move_mm", record.joining.transition_largest_move_mm}};
}

Json new_triangles_json(const NewTriangleFigures& figures) {
  Json json = figures.all.value_or(QualityFigures{});
  if (figures.inner) json["inner"] = *figures.inner;
  if (figures.at_border) json["at_border"] = *figures.at_border;
  json["promise_3_holds"] = figures.holds();
  return json;
}

Json stages_json(const std::vector<StageRecord>& stages) {
  Json json = Json::array();
  for (const StageRecord& s : stages)
    json.push_back({{"name", s.name}, {"seconds", s.seconds}, {"peak_memory_mb", s.peak_memory_mb}});
  return json;
}

Json input_json(const ReportedInput& input) {
  return {{"file", input.file_name ? Json(*input.file_name) : Json(nullptr)},
          {"sha256", input.sha256.empty() ? Json(nullptr) : Json(input.sha256)},
          {"rounded_to_float_mm", input.rounded_mm ? Json(*input.rounded_mm) : Json(nullptr)}};
}

/// What every report begins with.
Json heading() {
  return {{"report_version", report_version}, {"program", {{"name", "rhizodont"}, {"version", RHIZODONT_VERSION}}}};
}

Json words_for(ElementKind kind) {
  switch (kind) {
    case ElementKind::vertices:
      return "vertices";
    case ElementKind::triangles:
      return "triangles";
    case ElementKind::vertex_pairs:
      return "pairs of vertices";
    case ElementKind::triangle_pairs:
      return "pairs of triangles";
    case ElementKind::other:
      break;
  }
  return nullptr;
}

const char* kind_of(ErrorCode code) {
  switch (code) {
    case ErrorCode::wrong_usage:
      return "wrong usage";
    case ErrorCode::unusable_input:
      return "unusable input";
    case ErrorCode::no_result:
      return "no result that keeps the promises";
    case ErrorCode::partial:
      return "some teeth have no result";
    case ErrorCode::unwritable:
      return "results cannot be written";
    case ErrorCode::internal:
      break;
  }
  return "fault of the program";
}

}  // namespace

Json refusal_json(const Error& error) {
  return {{"exit_code", static_cast<int>(error.code())},
          {"kind", kind_of(error.code())},
          {"sentence", error.what()},
          {"ids_are", error.elements().empty() ? Json(nullptr) : words_for(error.kind())},
          {"ids", error.elements()}};
}

std::vector<std::string> all_warnings(const CompletionRecord& record) {
  std::vector<std::string> sentences = record.warnings;
  for (const MissedPlace& place : record.missed_places) {
    sentences.push_back(place.sentence);
    if (!place.crown_vertices.empty())
      sentences.back() += fmt::format(" It is beside the crown's vertices {}.", fmt::join(place.crown_vertices, ", "));
  }
  return sentences;
}

std::string completion_report(const CompletedTooth& tooth, const ReportedInput& input) {
  const CompletionRecord& record = tooth.record;
  Json json = heading();
  json.update({
      {"model", record.model},
      {"skirt_model", record.skirt_model},
      {"notice", "A predicted root is not the patient's anatomy. For research and visualisation only."},
      {"input", input_json(input)},
      {"options", Json(tooth.options)},
      {"fdi", {{"number", record.fdi}, {"guessed", record.fdi_guessed}}},
      {"likeness", likeness_json(record.likeness)},
      {"frame", frame_json(record)},
      {"crown", crown_json(record)},
      {"repairs", repairs_json(record.repairs)},
      {"root", root_json(record)},
      {"joining", joining_json(record)},
      {"new_triangles", new_triangles_json(record.promises.new_triangles)},
      {"promises", record.promises},
      {"stages", stages_json(record.stages)},
      {"warnings", all_warnings(record)},
  });
  return text_of(json);
}

std::string completion_refusal_report(const Error& error, const CompleteOptions& options, const ReportedInput& input,
                                      const std::vector<std::string>& warnings) {
  Json json = heading();
  json.update({{"input", input_json(input)},
               {"options", Json(options)},
               {"refused", refusal_json(error)},
               {"warnings", warnings}});
  return text_of(json);
}

}  // namespace rhizodont
