// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "serve/requests.hpp"

#include "report/json.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/json.hpp"
#include "teeth/fdi.hpp"
#include "teeth/label_numbers.hpp"

#include <fmt/format.h>

#include <array>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace rhizodont::serve {
namespace {

using Json = nlohmann::ordered_json;
using Takers = JsonTakers;

constexpr int deepest = 8;

Json object_from(std::string_view text, const char* what) {
  require_flat_json(text);
  Json json = Json::parse(text);
  if (!json.is_object()) throw UsageError(fmt::format("{} must be a JSON object.", what));
  return json;
}

int tooth_number(const std::string& number) {
  const auto fdi = read_fdi(number);
  if (!fdi) throw UsageError(fmt::format("There is no tooth {}.", shown(number)));
  return *fdi;
}

std::map<int, double> root_lengths(const Json& json) {
  std::map<int, double> lengths;
  for (const auto& [number, mm] : json.get<std::map<std::string, double>>()) lengths[tooth_number(number)] = mm;
  return lengths;
}

std::set<int> missing_teeth(const Json& json) {
  std::set<int> missing;
  for (const int number : json.get<std::vector<int>>()) missing.insert(tooth_number(std::to_string(number)));
  return missing;
}

std::map<int, Point> places_of_teeth(const Json& json) {
  std::map<int, Point> places;
  for (const auto& [number, place] : json.get<std::map<std::string, std::array<double, 3>>>())
    places[tooth_number(number)] = Point(place[0], place[1], place[2]);
  return places;
}

Point place_from(const Json& json) {
  const auto place = json.get<std::array<double, 3>>();
  return {place[0], place[1], place[2]};
}

/// {"number": 36, "at": [x, y, z]}, {"merge": [36, 37]}, {"split": 37, "at": [x, y, z]} or {"remove": 18}
LabelCorrection correction_from(const Json& json) {
  using Kind = LabelCorrection::Kind;
  LabelCorrection correction;
  int kinds = 0;
  bool has_place = false;
  const auto of_kind = [&](Kind kind) {
    return [&correction, &kinds, kind](const Json& v) {
      correction.kind = kind;
      correction.fdi = tooth_number(std::to_string(v.get<int>()));
      ++kinds;
    };
  };
  if (!json.is_object()) throw UsageError("A correction must be a JSON object.");
  take_members(json, "A correction", "has",
               {{"number", of_kind(Kind::number)},
                {"split", of_kind(Kind::split)},
                {"remove", of_kind(Kind::remove)},
                {"merge",
                 [&](const Json& v) {
                   const auto teeth = v.get<std::array<int, 2>>();
                   of_kind(Kind::merge)(teeth[0]);
                   correction.other = tooth_number(std::to_string(teeth[1]));
                 }},
                {"at", [&](const Json& v) {
                   correction.at = place_from(v);
                   has_place = true;
                 }}});
  const bool needs_place = correction.kind == Kind::number || correction.kind == Kind::split;
  if (kinds != 1 || has_place != needs_place)
    throw UsageError("A correction is one of number and split, each with a place (at), merge and remove.");
  return correction;
}

std::vector<LabelCorrection> corrections_from(const Json& json) {
  constexpr std::size_t most = 100;
  if (!json.is_array() || json.size() > most)
    throw UsageError(fmt::format("Corrections are a list of at most {}.", most));
  std::vector<LabelCorrection> corrections;
  for (const Json& each : json) corrections.push_back(correction_from(each));
  return corrections;
}

bool is_first(const std::string& word, const char* first, const char* second, const char* what) {
  if (word != first && word != second) throw UsageError(fmt::format("{} is {} or {}.", what, first, second));
  return word == first;
}

/// Options of every tooth of an arch: defects mended and skirts dropped, unless said otherwise.
CompleteOptions tooth_of_arch(const Json& options) {
  CompleteOptions given = options_from_json(options.dump());
  const CompleteOptions usual = ArchOptions::skirt_and_repair();
  if (!options.contains("skirt")) given.skirt = usual.skirt;
  if (!options.contains("repair")) given.repair = usual.repair;
  return given;
}

}  // namespace

void require_flat_json(std::string_view text) {
  const auto callback = [](int depth, nlohmann::json::parse_event_t, nlohmann::json&) {
    if (depth > deepest) throw UsageError("The JSON is nested too deeply.");
    return true;
  };
  try {
    if (nlohmann::json::parse(text, callback).is_discarded()) throw UsageError("The request is no JSON.");
  } catch (const nlohmann::json::exception&) {
    throw UsageError("The request is no JSON.");
  }
}

SentJob read_sent_job(std::string_view text) {
  const char* what = "A job";
  const Json json = object_from(text, what);
  SentJob job;
  Json options = Json::object();
  ArchOptions& arch = job.request.arch;
  ScanLabelSource& labels = job.request.labels;
  const Takers of_both{
      {"scan", [&](const Json& v) { job.scan = v.get<std::string>(); }},
      {"kind",
       [&](const Json& v) {
         job.request.kind =
             is_first(v.get<std::string>(), "tooth", "arch", "A job's kind") ? JobKind::tooth : JobKind::arch;
       }},
      {"options", [&](const Json& v) { options = v; }},
  };
  Takers of_arch{
      {"root_lengths_mm", [&](const Json& v) { arch.root_lengths = root_lengths(v); }},
      {"resolve_collisions", [&](const Json& v) { arch.resolve_collisions = v.get<bool>(); }},
      {"clearance_mm", [&](const Json& v) { arch.clearance_mm = v.get<double>(); }},
      {"missing", [&](const Json& v) { job.request.found.missing = missing_teeth(v); }},
      {"teeth", [&](const Json& v) { job.request.found.teeth = places_of_teeth(v); }},
      {"corrections", [&](const Json& v) { job.request.corrections = corrections_from(v); }},
      {"label_array", [&](const Json& v) { labels.array = v.get<std::string>(); }},
      {"labels_are", [&](const Json& v) { labels.numbers = read_label_numbers(v.get<std::string>()); }},
      {"jaw",
       [&](const Json& v) {
         labels.jaw = is_first(v.get<std::string>(), "upper", "lower", "A jaw") ? Jaw::upper : Jaw::lower;
       }},
      {"first_label",
       [&](const Json& v) {
         labels.first_is_patients_right =
             is_first(v.get<std::string>(), "right", "left", "The side of the first label");
       }},
  };
  const bool is_arch = json.contains("kind") && json["kind"] == "arch";
  Takers all = of_both;
  if (is_arch) all.merge(of_arch);
  take_members(json, is_arch ? "A job of an arch" : "A job of a tooth", "has", all);
  if (job.scan.empty()) throw UsageError("A job needs a scan.");
  if (is_arch) {
    arch.tooth = tooth_of_arch(options);
  } else {
    job.request.tooth = options_from_json(options.dump());
  }
  return job;
}

SentSteering read_sent_steering(std::string_view text) {
  Json json = object_from(text, "A root's steering");
  Json options = Json::object();
  if (const auto place = json.find("transition_mm"); place != json.end()) {
    options["transition_mm"] = *place;
    json.erase(place);
  }
  options["steering"] = json;
  const CompleteOptions read = options_from_json(options.dump());
  return {read.steering, read.transition};
}

}  // namespace rhizodont::serve
