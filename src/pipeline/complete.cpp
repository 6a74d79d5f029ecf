// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// "Completing Dental Models While Preserving Crown Geometry and Meshing Topology", figure 1: the order of the stages.

#include "rhizodont/complete.hpp"

#include "completion/complete_points.hpp"
#include "completion/steering.hpp"
#include "completion/uncertainty.hpp"
#include "fusion/fuse.hpp"
#include "mesh/closest_point.hpp"
#include "mesh/float_bits.hpp"
#include "mesh/geometry.hpp"
#include "pipeline/fitted_surface.hpp"
#include "pipeline/guiding_cloud.hpp"
#include "pipeline/missed_promise.hpp"
#include "pipeline/models.hpp"
#include "pipeline/report_parts.hpp"
#include "pipeline/stage_clock.hpp"
#include "pipeline/take_crown.hpp"
#include "rhizodont/check.hpp"
#include "rhizodont/error.hpp"
#include "skirt/skirt.hpp"

#include <fmt/format.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <limits>

namespace rhizodont {
namespace {

void require_options_in_range(const CompleteOptions& options) {
  if (!(options.e >= 0.2 && options.e <= 2))
    throw UsageError(fmt::format("e = {} mm is out of its range, 0.2 to 2 mm.", options.e));
  if (options.transition && !(*options.transition >= 0 && *options.transition <= 5))
    throw UsageError(fmt::format("A transition of {} mm is out of its range, 0 to 5 mm.", *options.transition));
  if (!(options.millimetres_per_unit > 0)) throw UsageError("The unit must be a positive number of millimetres.");
  if (options.threads < 0) throw UsageError("The number of threads cannot be negative.");
  if (options.fdi) tooth_type_of_fdi(*options.fdi);
  require_steering_in_range(options.steering);
}

/// FDI number and canonical pose; a number that was not given is guessed, and so said.
CrownFrame find_frame(const TriangleMesh& crown, const Atlas& atlas, const CompleteOptions& options,
                      CompletionRecord& record) {
  CrownFrame frame;
  if (options.fdi) {
    record.fdi = *options.fdi;
    frame = canonical_frame(crown, record.fdi, atlas.types[static_cast<std::size_t>(tooth_type_of_fdi(record.fdi))]);
  } else {
    const TypeGuess guess = guess_fdi_type(crown, atlas);
    record.fdi = guess.fdi;
    record.fdi_guessed = true;
    record.warnings.push_back(
        fmt::format("No FDI number was given; by its shape the crown was taken for tooth {}.", guess.fdi));
    frame = guess.frame;
  }
  record.type_residual_mm = frame.residual_mm;
  record.growth_axis = frame.frame.direction_to_world(Eigen::Vector3d::UnitZ());
  record.frame_rotation = frame.frame.rotation;
  record.frame_centre = frame.frame.centre;
  record.frame_mirrored = frame.frame.mirrored;
  return frame;
}

void note_guiding_distance(const TriangleMesh& crown, const TriangleMesh& surface, CompletionRecord& record) {
  const ClosestPointIndex index(surface);
  double sum = 0;
  for (const Point& p : crown.vertices) {
    const double d = index.closest(p).distance;
    sum += d;
    record.guiding_distance_max = std::max(record.guiding_distance_max, d);
  }
  record.guiding_distance_mean = sum / static_cast<double>(crown.vertices.size());
  record.guiding_vertices = static_cast<int>(surface.vertices.size());
}

void note_fusion(const FusedTooth& fused, CompletionRecord& record) {
  record.steiner_points = fused.steiner_points;
  record.crown_triangles_direct = fused.crown_triangles_direct;
  record.crown_triangles_restored = fused.tooth.triangles_brought_back;
  record.non_delaunay_edges_left = fused.non_delaunay_edges_left;
  record.root_sites = fused.root_sites;
  record.sites_without_cell = fused.sites_without_cell;
  record.triangles_filled = fused.tooth.triangles_filled;
  record.holes_filled = fused.tooth.holes_filled;
  const RootRemeshing& done = fused.remeshing;
  record.remeshing_operations = done.splits + done.collapses + done.flips + done.mended;
  record.sharpest_notch = fused.sharpest_notch;
  record.transition_vertices = static_cast<int>(fused.transition.vertices.size());
  const FuseSeconds& s = fused.seconds;
  record.joining_steps = {{"separation", s.separation}, {"root sites", s.sites},    {"diagram and dual", s.joining},
                          {"restoring", s.restoring},   {"remeshing", s.remeshing}, {"transition", s.transition}};
  record.transition_width_mm = fused.transition.width;
  record.transition_largest_move_mm = fused.transition.largest_move;
  record.warnings.insert(record.warnings.end(), fused.warnings.begin(), fused.warnings.end());
}

std::pair<double, double> extent_along(const std::vector<Point>& points, const Eigen::Vector3d& axis) {
  double low = std::numeric_limits<double>::max();
  double high = std::numeric_limits<double>::lowest();
  for (const Point& p : points) {
    low = std::min(low, p.dot(axis));
    high = std::max(high, p.dot(axis));
  }
  return {low, high};
}

void note_lengths(const TriangleMesh& crown, const TriangleMesh& tooth, CompletionRecord& record) {
  const auto [tooth_low, tooth_high] = extent_along(tooth.vertices, record.growth_axis);
  record.root_length_mm = extent_along(crown.vertices, record.growth_axis).first - tooth_low;
  record.tooth_length_mm = tooth_high - tooth_low;
}

/// How far new vertices and the root's length may be off. `tooth` in mm, the kept crown's vertices first.
void note_uncertainty(const TriangleMesh& crown, const TriangleMesh& tooth, const PredictedTooth& predicted,
                      const RootSteering& steering, CompletedTooth& completed) {
  CompletionRecord& record = completed.record;
  completed.uncertainty = expected_distances(tooth, crown, predicted, GuidingCloudOptions().correction_reach);
  record.apex_expected_distance_mm = expected_distance_at_apex(predicted, record.growth_axis);
  const std::optional<UncertaintyScales> scales = uncertainty_scales(record.model);
  if (!scales) return;
  for (double& u : completed.uncertainty) u *= scales->surface;
  if (steering.any()) return;
  const double s = record.apex_expected_distance_mm;
  record.root_interval = {record.root_length_mm + scales->length_low * s,
                          record.root_length_mm + scales->length_high * s, scales->apex * s};
}

/// The tooth in the input's unit: crown vertices are the input's own bits, new ones fit float where the input's do.
TriangleMesh in_input_unit(const TriangleMesh& tooth, const TriangleMesh& input, const std::vector<int>& kept,
                           double millimetres_per_unit) {
  TriangleMesh result = tooth;
  const bool as_float = coordinates_fit_float(input);
  for (std::size_t v = 0; v < result.vertices.size(); ++v) {
    Point& p = result.vertices[v];
    if (v < kept.size()) {
      p = input.vertices[static_cast<std::size_t>(kept[v])];
      continue;
    }
    p /= millimetres_per_unit;
    if (as_float) p = nearest_float(p);
  }
  return result;
}

/// As `check` does by the report: what a cap or a skirt was is not demanded, but repairs must leave the least share.
CheckReport prove_promises(const TriangleMesh& input, const TriangleMesh& tooth, const CompletionRecord& record) {
  CheckOptions options = allowing_for(record.repairs);
  options.dropped_vertices = vertices_not_of_tooth(record);
  options.compare_as_float = false;
  const CheckReport report = check(input, tooth, options);
  if (report.holds()) return report;
  std::string sentence = "No tooth was found that keeps the promises:";
  for (const std::string& failure : report.failures) sentence += " " + failure;
  throw NoResultError(sentence);
}

CompletedTooth complete(const TriangleMesh& input, const CompletionModels::Content& models,
                        const CompleteOptions& options, StageClock& clock) {
  CompletedTooth tooth;
  CompletionRecord& record = tooth.record;
  clock.begin("crown");
  const KeptCrown crown = take_crown(input, models.atlas, models.skirt, options, record);

  clock.begin("frame");
  const CrownFrame frame = find_frame(crown.mesh, models.atlas, options, record);
  clock.begin("completion network");
  record.model = models.network.metadata();
  PredictedTooth predicted = complete_points(crown.mesh, record.fdi, frame, models.network);
  clock.begin("orientation");
  const GuidingCloud cloud = assemble_guiding_cloud(crown.mesh, predicted.cloud);
  clock.begin("guiding surface");
  auto [surface, fit] = fitted_guiding_surface(cloud, crown.mesh, options.e);
  for (std::vector<Point>* points : {&surface.vertices, &predicted.cloud.points})
    steer_root(*points, crown.mesh, frame.frame, record.fdi, options.steering);
  note_guiding_distance(crown.mesh, surface, record);
  if (fit.undone)
    record.warnings.push_back(fmt::format(
        "Drawn onto the crown the guiding surface would have met itself, so it stays up to {:.2f} mm off the "
        "crown; look at the joint.",
        record.guiding_distance_max));

  clock.begin("joining");
  FuseOptions fuse;
  fuse.transition.width = options.transition;
  const FusedTooth fused = fuse_crown_and_root(crown.mesh, surface, record.growth_axis, fuse);
  note_fusion(fused, record);
  note_lengths(crown.mesh, fused.tooth.mesh, record);
  note_uncertainty(crown.mesh, fused.tooth.mesh, predicted, options.steering, tooth);

  clock.begin("check");
  tooth.mesh = in_input_unit(fused.tooth.mesh, input, crown.old_vertices, options.millimetres_per_unit);
  tooth.source.assign(tooth.mesh.vertices.size(), VertexSource::predicted);
  std::fill_n(tooth.source.begin(), crown.old_vertices.size(), VertexSource::scan);
  for (const int v : fused.transition.vertices) tooth.source[static_cast<std::size_t>(v)] = VertexSource::transition;
  record.promises = prove_promises(input, tooth.mesh, record);
  for (std::string& missed : where_promise_three_is_missed(tooth.mesh, crown.old_vertices, crown.mesh.triangles.size(),
                                                           record.promises.new_triangles))
    record.warnings.push_back(std::move(missed));
  return tooth;
}

}  // namespace

CompletedTooth complete_tooth(const TriangleMesh& crown, const CompletionModels& models, const CompleteOptions& options,
                              const ProgressCallback& progress) {
  require_options_in_range(options);
  std::optional<tbb::global_control> limit;
  if (options.threads > 0)
    limit.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(options.threads));
  StageClock clock(progress);
  CompletedTooth tooth = complete(crown, models.content(), options, clock);
  tooth.record.stages = clock.finish();
  return tooth;
}

std::vector<CompletedTooth> complete_candidates(const TriangleMesh& crown, const CompletionModels& models, int count,
                                                const CompleteOptions& options, const ProgressCallback& progress) {
  if (count < 1 || count > 9) throw UsageError("There can be 1 to 9 candidates.");
  std::vector<CompletedTooth> candidates{complete_tooth(crown, models, options, progress)};
  if (count == 1) return candidates;
  if (!candidates.front().record.root_interval)
    throw UsageError(options.steering.any() ? "Candidates differ in what steering sets: ask for one of the two."
                                            : "Candidates need a completion network that was calibrated.");
  // Copies: the vector moves its teeth when it grows.
  const RootInterval interval = *candidates.front().record.root_interval;
  const int fdi = candidates.front().record.fdi;
  for (int i = 0; i + 1 < count; ++i) {
    CompleteOptions of_this = options;
    of_this.fdi = fdi;
    const double share = count == 2 ? 0 : static_cast<double>(i) / (count - 2);
    of_this.steering.length_mm = std::lerp(interval.length_low_mm, interval.length_high_mm, share);
    candidates.push_back(complete_tooth(crown, models, of_this, progress));
  }
  return candidates;
}

}  // namespace rhizodont
