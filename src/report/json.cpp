// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/json.hpp"

namespace rhizodont {
namespace {

using Json = nlohmann::ordered_json;

template <class T>
Json value_or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json crown_json(const CrownCheck& crown) {
  Json json{{"holds", crown.holds},
            {"compared_as", crown.compared_as_float ? "float" : "double"},
            {"vertices", crown.vertices},
            {"kept_vertices", crown.kept_vertices},
            {"dropped_vertices", crown.dropped_vertices},
            {"merged_vertices", crown.merged_vertices},
            {"merged_distance_max_mm", crown.merged_distance_max},
            {"triangles", crown.triangles},
            {"kept_triangles", crown.kept_triangles},
            {"repaired_triangles", crown.repaired_triangles},
            {"kept_share", crown.kept_share},
            {"demanded_triangles", crown.demanded_triangles},
            {"broken_triangles", crown.broken_triangles},
            {"deviation", nullptr}};
  if (crown.deviation)
    json["deviation"] = {{"max_mm", crown.deviation->max},
                         {"mean_mm", crown.deviation->mean},
                         {"bins_up_to_mm", {1e-3, 1e-2, 1e-1, nullptr}},
                         {"bins", crown.deviation->bins}};
  return json;
}

Json solid_json(const SolidCheck& solid) {
  return {{"holds", solid.holds},
          {"valid", solid.valid},
          {"vertices", solid.vertices},
          {"triangles", solid.triangles},
          {"unreferenced_vertices", solid.unreferenced_vertices},
          {"border_edges", solid.border_edges},
          {"non_manifold_edges", solid.non_manifold_edges},
          {"misoriented_edges", solid.misoriented_edges},
          {"non_manifold_vertices", solid.non_manifold_vertices},
          {"components", solid.components},
          {"euler_number", solid.euler_number},
          {"genus", value_or_null(solid.genus)},
          {"volume_mm3", solid.volume},
          {"self_intersections", solid.self_intersections}};
}

Json directions_or_null(const std::optional<ToothDirections>& directions) {
  if (!directions) return nullptr;
  return {{"occlusal", numbers(directions->occlusal)}, {"buccal", numbers(directions->buccal)}};
}

}  // namespace

Json numbers(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

std::string text_of(const Json& json) { return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n"; }

void to_json(Json& json, const CompleteOptions& options) {
  const RootSteering& steering = options.steering;
  json = Json{{"fdi", value_or_null(options.fdi)},
              {"e_mm", options.e},
              {"repair", options.repair},
              {"skirt", options.skirt ? Json(*options.skirt) : Json("keep")},
              {"cap", options.cap == CapHandling::keep ? "keep" : "drop"},
              {"millimetres_per_unit", options.millimetres_per_unit},
              {"transition_mm", value_or_null(options.transition)},
              {"directions", directions_or_null(options.directions)},
              {"steering",
               {{"root_length_mm", value_or_null(steering.length_mm)},
                {"tip_degrees", steering.tip_degrees},
                {"torque_degrees", steering.torque_degrees},
                {"bend_degrees", steering.bend_degrees}}},
              {"threads", options.threads}};
}

void to_json(Json& json, const QualityFigures& figures) {
  json = Json{{"triangles", figures.triangles},
              {"q_avg", figures.q_avg},
              {"q_min", figures.q_min},
              {"theta_avg", figures.theta_avg},
              {"theta_min", figures.theta_min},
              {"theta_max", figures.theta_max},
              {"percent_below_30", figures.percent_below_30}};
}

void to_json(Json& json, const CheckReport& report) {
  json = Json{{"holds", report.holds()},
              {"failures", report.failures},
              {"crown", crown_json(report.crown)},
              {"solid", solid_json(report.solid)},
              {"quality_new_triangles", value_or_null(report.new_triangles.all)},
              {"quality_new_triangles_inner", value_or_null(report.new_triangles.inner)},
              {"quality_new_triangles_at_border", value_or_null(report.new_triangles.at_border)},
              {"promise_3_holds", report.new_triangles.holds()},
              {"quality_all_triangles", value_or_null(report.all_triangles)}};
}

void to_json(Json& json, const MeshMeasures& m) {
  json = Json{{"quality", m.quality},
              {"topology",
               {{"vertices", m.vertices},
                {"edges", m.edges},
                {"triangles", m.triangles},
                {"unreferenced_vertices", m.unreferenced_vertices},
                {"duplicate_vertices", m.duplicate_vertices},
                {"duplicate_triangles", m.duplicate_triangles},
                {"degenerate_triangles", m.degenerate_triangles},
                {"border_edges", m.border_edges},
                {"non_manifold_edges", m.non_manifold_edges},
                {"misoriented_edges", m.misoriented_edges},
                {"non_manifold_vertices", m.non_manifold_vertices},
                {"self_intersections", m.self_intersections},
                {"components", m.components},
                {"border_loops", m.border_loops},
                {"euler_number", m.euler_number},
                {"genus", value_or_null(m.genus)},
                {"defects", m.defects}}},
              {"size",
               {{"closed", m.closed},
                {"volume_mm3", m.closed ? Json(m.volume) : Json(nullptr)},
                {"area_mm2", m.area},
                {"lowest_mm", m.lowest},
                {"highest_mm", m.highest},
                {"diagonal_mm", m.diagonal},
                {"edge_min_mm", m.edge_min},
                {"edge_mean_mm", m.edge_mean},
                {"edge_max_mm", m.edge_max}}}};
}

void to_json(Json& json, const FoundTooth& tooth) {
  json = {{"fdi", tooth.fdi},
          {"confidence", tooth.confidence},
          {"second", value_or_null(tooth.second)},
          {"second_confidence", tooth.second_confidence}};
}

}  // namespace rhizodont
