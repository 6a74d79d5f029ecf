// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "rhizodont/json.hpp"

#include "report/json.hpp"
#include "rhizodont/error.hpp"

#include <fmt/format.h>

#include <array>

#include <functional>
#include <map>

namespace rhizodont {
namespace {

using Json = nlohmann::ordered_json;

template <class T>
void read(const Json& json, const char* name, T& into) {
  json.at(name).get_to(into);
}

template <class T>
void read(const Json& json, const char* name, std::optional<T>& into) {
  into = json.at(name).is_null() ? std::nullopt : std::optional<T>(json.at(name).get<T>());
}

CrownCheck read_crown(const Json& json) {
  CrownCheck crown;
  read(json, "holds", crown.holds);
  crown.compared_as_float = json.at("compared_as").get<std::string>() == "float";
  read(json, "vertices", crown.vertices);
  read(json, "kept_vertices", crown.kept_vertices);
  read(json, "dropped_vertices", crown.dropped_vertices);
  read(json, "merged_vertices", crown.merged_vertices);
  read(json, "merged_distance_max_mm", crown.merged_distance_max);
  read(json, "triangles", crown.triangles);
  read(json, "kept_triangles", crown.kept_triangles);
  read(json, "repaired_triangles", crown.repaired_triangles);
  read(json, "kept_share", crown.kept_share);
  read(json, "demanded_triangles", crown.demanded_triangles);
  read(json, "broken_triangles", crown.broken_triangles);
  if (const Json& deviation = json.at("deviation"); !deviation.is_null()) {
    crown.deviation.emplace();
    read(deviation, "max_mm", crown.deviation->max);
    read(deviation, "mean_mm", crown.deviation->mean);
    read(deviation, "bins", crown.deviation->bins);
  }
  return crown;
}

SolidCheck read_solid(const Json& json) {
  SolidCheck solid;
  read(json, "holds", solid.holds);
  read(json, "valid", solid.valid);
  read(json, "vertices", solid.vertices);
  read(json, "triangles", solid.triangles);
  read(json, "unreferenced_vertices", solid.unreferenced_vertices);
  read(json, "border_edges", solid.border_edges);
  read(json, "non_manifold_edges", solid.non_manifold_edges);
  read(json, "misoriented_edges", solid.misoriented_edges);
  read(json, "non_manifold_vertices", solid.non_manifold_vertices);
  read(json, "components", solid.components);
  read(json, "euler_number", solid.euler_number);
  read(json, "genus", solid.genus);
  read(json, "volume_mm3", solid.volume);
  read(json, "self_intersections", solid.self_intersections);
  return solid;
}

/// How the value of each name of a JSON object is taken.
using Takers = JsonTakers;

template <class T>
auto taker(T& into) {
  return [&into](const Json& value) { value.get_to(into); };
}

template <class T>
auto taker(std::optional<T>& into) {
  return [&into](const Json& value) { into = value.is_null() ? std::nullopt : std::optional<T>(value.get<T>()); };
}

/// A choice between words.
template <class T>
auto choice(T& into, std::map<std::string, T> words) {
  return [&into, words = std::move(words)](const Json& value) {
    const auto found = words.find(value.is_string() ? value.get<std::string>() : "");
    if (found == words.end()) throw Json::other_error::create(501, "no such word", &value);
    into = found->second;
  };
}

template <class T>
auto whole_number(T& into) {
  return [&into](const Json& value) {
    if (!value.is_null() && !value.is_number_integer()) throw Json::other_error::create(501, "not whole", &value);
    taker(into)(value);
  };
}

auto direction(Eigen::Vector3d& into) {
  return [&into](const Json& value) {
    const auto numbers = value.get<std::array<double, 3>>();
    into = {numbers[0], numbers[1], numbers[2]};
  };
}

template <class T>
T figures_from(std::string_view text, const char* what) {
  try {
    return Json::parse(text).get<T>();
  } catch (const Json::parse_error& error) {  // its words quote the text, which may hold any bytes
    throw InputError(fmt::format("This is not the JSON of {}: it is no JSON from byte {} on.", what, error.byte));
  } catch (const Json::exception& error) {
    throw InputError(fmt::format("This is not the JSON of {}: {}.", what, error.what()));
  }
}

}  // namespace

std::string shown(const nlohmann::ordered_json& json) {
  constexpr std::size_t longest = 60;
  const std::string text = json.dump(-1, ' ', true);
  return text.size() <= longest ? text : text.substr(0, longest) + "...";
}

void take_members(const Json& json, const std::string& subject, const char* verb, const JsonTakers& takers) {
  if (!json.is_object()) throw UsageError(fmt::format("{} must be a JSON object.", subject));
  for (const auto& [name, value] : json.items()) {
    const auto taker = takers.find(name);
    if (taker == takers.end()) throw UsageError(fmt::format("{} {} no {}.", subject, verb, shown(name)));
    try {
      taker->second(value);
    } catch (const Json::exception&) {
      throw UsageError(fmt::format("{}: the value of \"{}\" cannot be {}.", subject, name, shown(value)));
    }
  }
}

void from_json(const Json& json, QualityFigures& figures) {
  read(json, "triangles", figures.triangles);
  read(json, "q_avg", figures.q_avg);
  read(json, "q_min", figures.q_min);
  read(json, "theta_avg", figures.theta_avg);
  read(json, "theta_min", figures.theta_min);
  read(json, "theta_max", figures.theta_max);
  read(json, "percent_below_30", figures.percent_below_30);
}

void from_json(const Json& json, CheckReport& report) {
  report.crown = read_crown(json.at("crown"));
  report.solid = read_solid(json.at("solid"));
  read(json, "quality_new_triangles", report.new_triangles.all);
  read(json, "quality_new_triangles_inner", report.new_triangles.inner);
  read(json, "quality_new_triangles_at_border", report.new_triangles.at_border);
  read(json, "quality_all_triangles", report.all_triangles);
  read(json, "failures", report.failures);
}

void from_json(const Json& json, MeshMeasures& m) {
  read(json, "quality", m.quality);
  const Json &topology = json.at("topology"), &size = json.at("size");
  read(topology, "vertices", m.vertices);
  read(topology, "edges", m.edges);
  read(topology, "triangles", m.triangles);
  read(topology, "unreferenced_vertices", m.unreferenced_vertices);
  read(topology, "duplicate_vertices", m.duplicate_vertices);
  read(topology, "duplicate_triangles", m.duplicate_triangles);
  read(topology, "degenerate_triangles", m.degenerate_triangles);
  read(topology, "border_edges", m.border_edges);
  read(topology, "non_manifold_edges", m.non_manifold_edges);
  read(topology, "misoriented_edges", m.misoriented_edges);
  read(topology, "non_manifold_vertices", m.non_manifold_vertices);
  read(topology, "self_intersections", m.self_intersections);
  read(topology, "components", m.components);
  read(topology, "border_loops", m.border_loops);
  read(topology, "euler_number", m.euler_number);
  read(topology, "genus", m.genus);
  read(topology, "defects", m.defects);
  read(size, "closed", m.closed);
  if (m.closed) read(size, "volume_mm3", m.volume);
  read(size, "area_mm2", m.area);
  read(size, "lowest_mm", m.lowest);
  read(size, "highest_mm", m.highest);
  read(size, "diagonal_mm", m.diagonal);
  read(size, "edge_min_mm", m.edge_min);
  read(size, "edge_mean_mm", m.edge_mean);
  read(size, "edge_max_mm", m.edge_max);
}

std::string options_to_json(const CompleteOptions& options) { return Json(options).dump(1); }
std::string check_to_json(const CheckReport& report) { return Json(report).dump(1); }
std::string measures_to_json(const MeshMeasures& measures) { return Json(measures).dump(1); }

CompleteOptions options_from_json(std::string_view text) {
  CompleteOptions options;
  RootSteering& steering = options.steering;
  const Takers steering_takers{{"root_length_mm", taker(steering.length_mm)},
                               {"tip_degrees", taker(steering.tip_degrees)},
                               {"torque_degrees", taker(steering.torque_degrees)},
                               {"bend_degrees", taker(steering.bend_degrees)}};
  const auto take_directions = [&](const Json& value) {
    options.directions.reset();
    if (value.is_null()) return;
    ToothDirections& directions = options.directions.emplace();
    take_members(value, "The tooth's directions", "have",
                 {{"occlusal", direction(directions.occlusal)}, {"buccal", direction(directions.buccal)}});
  };
  const auto take_skirt = [&](const Json& value) {
    if (value.is_string()) {
      choice(options.skirt, {{"keep", std::nullopt}, {"auto", 0.5}})(value);
    } else {
      options.skirt = value.get<double>();
    }
  };
  const Takers takers{
      {"fdi", whole_number(options.fdi)},
      {"e_mm", taker(options.e)},
      {"repair", taker(options.repair)},
      {"skirt", take_skirt},
      {"cap", choice(options.cap, {{"keep", CapHandling::keep}, {"drop", CapHandling::drop}})},
      {"millimetres_per_unit", taker(options.millimetres_per_unit)},
      {"transition_mm", taker(options.transition)},
      {"directions", take_directions},
      {"steering", [&](const Json& value) { take_members(value, "The options of steering", "have", steering_takers); }},
      {"threads", whole_number(options.threads)}};
  Json json;
  try {
    json = Json::parse(text);
  } catch (const Json::exception&) {
    throw UsageError("The options are no JSON.");
  }
  take_members(json, "The options", "have", takers);
  return options;
}

CheckReport check_from_json(std::string_view text) { return figures_from<CheckReport>(text, "a check"); }
MeshMeasures measures_from_json(std::string_view text) { return figures_from<MeshMeasures>(text, "measures"); }

}  // namespace rhizodont
