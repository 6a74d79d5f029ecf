// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// "Completing Dental Models While Preserving Crown Geometry and Meshing Topology", figure 1: the order of the stages,
// from the guiding surface on.

#include "base/float_bits.hpp"
#include "completion/steering.hpp"
#include "completion/uncertainty.hpp"
#include "fusion/fuse.hpp"
#include "guiding/guiding_cloud.hpp"
#include "intake/part_of_mesh.hpp"
#include "mesh/closest_point.hpp"
#include "mesh/geometry.hpp"
#include "pipeline/missed_promise.hpp"
#include "pipeline/moved_tooth.hpp"
#include "pipeline/prepared_tooth.hpp"
#include "pipeline/report_parts.hpp"
#include "pipeline/stage_clock.hpp"
#include "rhizodont/check.hpp"
#include "rhizodont/complete.hpp"
#include "rhizodont/error.hpp"

#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

namespace rhizodont {
namespace {

void note_guiding_distance(const TriangleMesh& crown, const TriangleMesh& surface, JoiningRecord& joining) {
  const ClosestPointIndex index(surface);
  std::vector<double> distances(crown.vertices.size());
  tbb::parallel_for(std::size_t{0}, distances.size(),
                    [&](std::size_t v) { distances[v] = index.closest(crown.vertices[v]).distance; });
  double sum = 0;
  for (const double d : distances) {
    sum += d;
    joining.guiding_distance_max_mm = std::max(joining.guiding_distance_max_mm, d);
  }
  joining.guiding_distance_mean_mm = sum / static_cast<double>(crown.vertices.size());
  joining.guiding_vertices = static_cast<int>(surface.vertices.size());
}

void note_fusion(const FusedTooth& fused, JoiningRecord& joining) {
  joining.steiner_points = fused.steiner_points;
  joining.crown_triangles_direct = fused.crown_triangles_direct;
  joining.crown_triangles_restored = fused.tooth.triangles_brought_back;
  joining.non_delaunay_edges_left = fused.non_delaunay_edges_left;
  joining.root_sites = fused.root_sites;
  joining.sites_without_cell = fused.sites_without_cell;
  joining.triangles_filled = fused.tooth.triangles_filled;
  joining.holes_filled = fused.tooth.holes_filled;
  const RootRemeshing& done = fused.remeshing;
  joining.remeshing_operations = done.splits + done.collapses + done.flips + done.mended;
  joining.sharpest_notch_degrees = fused.sharpest_notch;
  joining.transition_vertices = static_cast<int>(fused.transition.vertices.size());
  const FuseSeconds& s = fused.seconds;
  joining.steps = {{"separation", s.separation}, {"root sites", s.sites},    {"diagram and dual", s.joining},
                   {"restoring", s.restoring},   {"remeshing", s.remeshing}, {"transition", s.transition}};
  joining.transition_width_mm = fused.transition.width;
  joining.transition_largest_move_mm = fused.transition.largest_move;
}

RootRecord root_record(const TriangleMesh& crown, const TriangleMesh& tooth, const Eigen::Vector3d& growth_axis,
                       RootSource source) {
  const auto [tooth_low, tooth_high] = extent_along(tooth.vertices, growth_axis);
  RootRecord root;
  root.source = source;
  root.length_mm = extent_along(crown.vertices, growth_axis).first - tooth_low;
  root.tooth_length_mm = tooth_high - tooth_low;
  return root;
}

/// How far new vertices and the root's length may be off. `tooth` in mm, the kept crown's vertices first.
void note_uncertainty(const PreparedCrown& crown, const TriangleMesh& tooth, const PredictedTooth& predicted,
                      const Eigen::Vector3d& growth_axis, const RootSteering& steering, CompletedTooth& completed) {
  CompletionRecord& record = completed.record;
  completed.uncertainty = expected_distances(tooth, crown, predicted, GuidingCloudOptions().correction_reach);
  record.root.apex_expected_distance_mm = expected_distance_at_apex(predicted, growth_axis);
  const std::optional<UncertaintyScales> scales = uncertainty_scales(record.model, record.fdi);
  if (!scales) return;
  for (double& u : completed.uncertainty) u *= scales->surface;
  if (steering.any()) return;
  const double s = record.root.apex_expected_distance_mm;
  const auto [low, high] = length_interval(record.root.length_mm, s, *scales);
  record.root.interval = {low, high, scales->apex * s};
}

/// What the promises come to, kept or not. As `check` does by the report: what a cap or a skirt was is not demanded,
/// but repairs must leave the least share.
CheckReport evidence(const TriangleMesh& input, const TriangleMesh& tooth, const CompletionRecord& record) {
  CheckOptions options = allowing_for(record.repairs);
  options.dropped_vertices = vertices_not_of_tooth(record);
  options.compare_as_float = false;
  return check(input, tooth, options);
}

/// Throws NoResultError where they are not kept.
void require_promises(const CheckReport& promises) {
  if (promises.holds()) return;
  std::string sentence = "No tooth was found that keeps the promises:";
  for (const std::string& failure : promises.failures) sentence += " " + failure;
  throw NoResultError(sentence);
}

/// Brings the tooth back to where the input is, with evidence for the promises. Far from the origin floats lie so wide
/// apart that new triangles may come to cross each other: then the new vertices keep all their digits.
void put_in_place(const TriangleMesh& fused, const TriangleMesh& input, const std::vector<int>& kept, Workplace place,
                  CompletedTooth& tooth) {
  CompletionRecord& record = tooth.record;
  tooth.mesh = in_input_coordinates(fused, input, kept, place);
  record.promises = evidence(input, tooth.mesh, record);
  if (!record.promises.holds() && place.as_float && place.is_far) {
    place.as_float = false;
    tooth.mesh = in_input_coordinates(fused, input, kept, place);
    record.promises = evidence(input, tooth.mesh, record);
    record.warnings.push_back(
        "The crown lies so far from the origin that single precision is too coarse for new triangles: new vertices "
        "have double precision. Move the scan to the origin for STL.");
  }
  require_promises(record.promises);
}

/// Numbers of those that are `kept` of the input, in the input's order.
std::vector<int> in_order_of_input(const std::vector<int>& kept) {
  std::vector<int> order(kept.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return kept[static_cast<std::size_t>(a)] < kept[static_cast<std::size_t>(b)]; });
  return order;
}

/// A tooth with the kept crown's vertices and triangles as the input has them one after the other, and triangles
/// beginning with the same corner. @param tooth  the crown's first, as they come at the workplace
TriangleMesh with_crown_in_order(const TriangleMesh& tooth, const PreparedTooth::Content& prepared) {
  TriangleMesh result = tooth;
  const std::vector<int> vertices = in_order_of_input(prepared.old_vertices);
  std::vector<std::int32_t> place(tooth.vertices.size());
  std::iota(place.begin(), place.end(), 0);
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    result.vertices[v] = tooth.vertices[static_cast<std::size_t>(vertices[v])];
    place[static_cast<std::size_t>(vertices[v])] = static_cast<std::int32_t>(v);
  }
  const std::vector<int> triangles = in_order_of_input(prepared.old_triangles);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto from = static_cast<std::size_t>(triangles[t]);
    Triangle corners = tooth.triangles[from];
    const std::int32_t first = prepared.input.triangles[static_cast<std::size_t>(prepared.old_triangles[from])][0];
    const auto begins = std::find_if(corners.begin(), corners.end(), [&](std::int32_t v) {
      return prepared.old_vertices[static_cast<std::size_t>(v)] == first;
    });
    if (begins != corners.end()) std::rotate(corners.begin(), begins, corners.end());
    result.triangles[t] = corners;
  }
  for (Triangle& t : result.triangles)
    for (std::int32_t& v : t) v = place[static_cast<std::size_t>(v)];
  return result;
}

/// Joins the steered root to the crown. `tooth`: its options, and the record of the preparation.
void finish(const PreparedTooth::Content& prepared, StageClock& clock, CompletedTooth& tooth) {
  CompletionRecord& record = tooth.record;
  const PreparedCrown& crown = prepared.crown;
  const Eigen::Vector3d growth_axis = prepared.frame.direction_to_world(Eigen::Vector3d::UnitZ());
  const RootSteering& steering = tooth.options.steering;
  clock.begin("joining");
  TriangleMesh surface = prepared.surface.mesh;
  PredictedTooth predicted = prepared.predicted;
  for (std::vector<Point>* points : {&surface.vertices, &predicted.cloud.points})
    steer_root(*points, crown.mesh, prepared.frame, record.fdi, steering);
  note_guiding_distance(crown.mesh, surface, record.joining);
  if (prepared.surface.fit.undone)
    record.warnings.push_back(fmt::format(
        "Drawn onto the crown the guiding surface would have met itself, so it stays up to {:.2f} mm off the "
        "crown; look at the joint.",
        record.joining.guiding_distance_max_mm));
  FuseOptions fuse;
  fuse.transition.width = tooth.options.transition;
  FusedTooth fused = on_part(prepared.old_vertices, prepared.old_triangles,
                             [&] { return fuse_crown_and_root(crown, surface, growth_axis, fuse); });
  note_fusion(fused, record.joining);
  record.warnings.insert(record.warnings.end(), fused.warnings.begin(), fused.warnings.end());
  record.root = root_record(crown.mesh, fused.tooth.mesh, growth_axis, record.root.source);
  if (!steering.any() && record.root.length_mm < shortest_root_mm)
    throw NoResultError(fmt::format(
        "The root would be only {:.1f} mm long. Is the crown whole, and is its open base where the root is to begin?",
        record.root.length_mm));
  note_uncertainty(crown, fused.tooth.mesh, predicted, growth_axis, steering, tooth);

  clock.begin("check");
  const std::vector<int>& kept = record.crown.kept_vertices;
  tooth.source.assign(fused.tooth.mesh.vertices.size(), VertexSource::predicted);
  std::fill_n(tooth.source.begin(), kept.size(), VertexSource::scan);
  for (const int v : fused.transition.vertices) tooth.source[static_cast<std::size_t>(v)] = VertexSource::transition;
  if (prepared.place.reordered) fused.tooth.mesh = with_crown_in_order(fused.tooth.mesh, prepared);
  put_in_place(fused.tooth.mesh, prepared.input, kept, prepared.place, tooth);
  record.missed_places =
      where_promise_three_is_missed(tooth.mesh, kept, crown.mesh.triangles.size(), record.promises.new_triangles);
}

}  // namespace

CompletedTooth finished_tooth(const PreparedTooth::Content& content, const RootSteering& steering,
                              std::optional<double> transition, const ProgressCallback& progress) {
  CompletedTooth tooth;
  tooth.options = content.options;
  tooth.options.steering = steering;
  tooth.options.transition = transition;
  require_options_in_range(tooth.options);
  tooth.record = content.record;
  return with_threads(content.options.threads, [&] {
    StageClock clock(progress);
    const auto hint = [&] {
      return hint_at_options(at_workplace(content.input, content.place), content.place, *content.models,
                             content.options, content.old_vertices);
    };
    letting_callbacks_throw([&] { hinting([&] { finish(content, clock, tooth); }, hint); });
    const std::vector<StageRecord> stages = clock.finish();
    tooth.record.stages.insert(tooth.record.stages.end(), stages.begin(), stages.end());
    return std::move(tooth);
  });
}

CompletedTooth moved_tooth(const TriangleMesh& crown, CompletedTooth tooth, const std::vector<Point>& vertices) {
  if (vertices.size() != tooth.mesh.vertices.size())
    throw UsageError(fmt::format("{} places are given for {} vertices.", vertices.size(), tooth.mesh.vertices.size()));
  CompletionRecord& record = tooth.record;
  const double unit = record.millimetres_per_unit;
  const bool as_float = coordinates_fit_float(tooth.mesh);
  const auto lowest = [&] { return unit * extent_along(tooth.mesh.vertices, record.frame.growth_axis).first; };
  const double before = lowest();
  for (std::size_t v = record.crown.kept_vertices.size(); v < vertices.size(); ++v) {
    // What stays keeps its bits in any unit.
    if (vertices[v] == unit * tooth.mesh.vertices[v]) continue;
    const Point place = vertices[v] / unit;
    tooth.mesh.vertices[v] = as_float ? nearest_float(place) : place;
  }
  const double longer = before - lowest();
  record.root.length_mm += longer;
  record.root.tooth_length_mm += longer;
  if (record.root.interval)
    for (double* mm : {&record.root.interval->length_low_mm, &record.root.interval->length_high_mm}) *mm += longer;
  record.promises = evidence(crown, tooth.mesh, record);
  require_promises(record.promises);
  record.missed_places = where_promise_three_is_missed(tooth.mesh, record.crown.kept_vertices,
                                                       static_cast<std::size_t>(record.crown.kept_triangles),
                                                       record.promises.new_triangles);
  return tooth;
}

CompletedTooth finish_tooth(const PreparedTooth& prepared, const RootSteering& steering,
                            std::optional<double> transition, const ProgressCallback& progress) {
  return finished_tooth(*prepared.content_, steering, transition, progress);
}

}  // namespace rhizodont
