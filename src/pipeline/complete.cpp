// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// "Completing Dental Models While Preserving Crown Geometry and Meshing Topology", figure 1: the order of the stages.

#include "rhizodont/complete.hpp"

#include "base/float_bits.hpp"
#include "completion/complete_points.hpp"
#include "completion/steering.hpp"
#include "completion/uncertainty.hpp"
#include "fusion/fuse.hpp"
#include "guiding/fitted_surface.hpp"
#include "guiding/guiding_cloud.hpp"
#include "intake/part_of_mesh.hpp"
#include "intake/take_crown.hpp"
#include "mesh/closest_point.hpp"
#include "mesh/geometry.hpp"
#include "pipeline/crown_likeness.hpp"
#include "pipeline/missed_promise.hpp"
#include "pipeline/models.hpp"
#include "pipeline/prediction.hpp"
#include "pipeline/report_parts.hpp"
#include "pipeline/stage_clock.hpp"
#include "pipeline/way_out.hpp"
#include "rhizodont/check.hpp"
#include "rhizodont/error.hpp"
#include "skirt/skirt.hpp"
#include "teeth/fdi.hpp"

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace rhizodont {
namespace {

void require_options_in_range(const CompleteOptions& options) {
  if (!(options.e >= 0.2 && options.e <= 2))
    throw UsageError(fmt::format("e = {} mm is out of its range, 0.2 to 2 mm.", options.e));
  if (options.transition && !(*options.transition >= 0 && *options.transition <= 5))
    throw UsageError(fmt::format("A transition of {} mm is out of its range, 0 to 5 mm.", *options.transition));
  if (options.skirt && !(*options.skirt > 0 && *options.skirt < 1))
    throw UsageError(
        fmt::format("A confidence for a skirt of {} is out of its range, above 0 and below 1.", *options.skirt));
  if (!(options.millimetres_per_unit > 0 && std::isfinite(options.millimetres_per_unit)))
    throw UsageError("The unit must be a positive number of millimetres.");
  if (options.threads < 0) throw UsageError("The number of threads cannot be negative.");
  if (options.fdi) tooth_type_of_fdi(*options.fdi);
  require_steering_in_range(options.steering);
}

/// Which tooth the crown is, whether it looks like it, and its canonical pose; a number that was not given is guessed,
/// and so said.
CrownFrame find_frame(const TriangleMesh& crown, const CompletionModels::Content& models,
                      const CompleteOptions& options, CompletionRecord& record) {
  record.fdi_guessed = !options.fdi;
  record.millimetres_per_unit = options.millimetres_per_unit;
  if (models.likeness) {
    record.likeness = judge_crown(crown, options.fdi, models.atlas, *models.likeness);
    record.fdi = record.likeness->said.fdi;
    if (auto warning = likeness_warning(*record.likeness, record.fdi_guessed))
      record.warnings.push_back(std::move(*warning));
  } else {
    record.fdi = options.fdi ? *options.fdi : guess_fdi_type(crown, models.atlas).fdi;
    if (record.fdi_guessed)
      record.warnings.push_back(
          fmt::format("No FDI number was given; by its shape the crown was taken for tooth {}.", record.fdi));
  }
  return canonical_frame(crown, record.fdi,
                         models.atlas.types[static_cast<std::size_t>(tooth_type_of_fdi(record.fdi))]);
}

/// The predicted tooth, and what was done to get it.
RootPrediction predict(const TriangleMesh& crown, const CrownFrame& frame, const CompletionModels::Content& models,
                       const std::function<bool(const RootPrediction&)>& makes_a_root, CompletionRecord& record) {
  RootPrediction prediction = predict_tooth(crown, record.fdi, frame, models, makes_a_root);
  const CanonicalFrame& pose = prediction.frame.frame;
  record.type_residual_mm = prediction.frame.residual_mm;
  record.growth_axis = pose.direction_to_world(Eigen::Vector3d::UnitZ());
  record.frame_rotation = pose.rotation;
  record.frame_centre = pose.centre;
  record.frame_mirrored = pose.mirrored;
  record.root_source = prediction.source;
  if (prediction.source == RootSource::network_laid_anew)
    record.warnings.push_back(
        "The first prediction of the root fell to pieces; the crown was laid anew. Look at the root, and check the "
        "tooth's number.");
  if (prediction.source == RootSource::mean_tooth)
    record.warnings.push_back(fmt::format(
        "No root could be predicted from this crown; it has that of a mean {}, and nothing of its own. Check the "
        "tooth's number and whether the crown is whole.",
        record.fdi));
  return prediction;
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
  const auto [low, high] = length_interval(record.root_length_mm, s, *scales);
  record.root_interval = {low, high, scales->apex * s};
}

/// Where the stages have their origin, in the input's coordinates.
struct Workplace {
  Point origin = Point::Zero();  // the input's own, unless the crown lies far from it
  double millimetres_per_unit = 1;
  bool as_float = true;  // new coordinates are rounded to float, as the input's are
};

/// The tooth in the input's coordinates: crown vertices are the input's own bits.
TriangleMesh in_input_coordinates(const TriangleMesh& tooth, const TriangleMesh& input, const std::vector<int>& kept,
                                  const Workplace& place) {
  TriangleMesh result = tooth;
  for (std::size_t v = 0; v < result.vertices.size(); ++v) {
    Point& p = result.vertices[v];
    if (v < kept.size()) {
      p = input.vertices[static_cast<std::size_t>(kept[v])];
      continue;
    }
    p = p / place.millimetres_per_unit + place.origin;
    if (place.as_float) p = nearest_float(p);
  }
  return result;
}

/// What the promises come to, kept or not. As `check` does by the report: what a cap or a skirt was is not demanded,
/// but repairs must leave the least share.
CheckReport evidence(const TriangleMesh& input, const TriangleMesh& tooth, const CompletionRecord& record) {
  CheckOptions options = allowing_for(record.repairs);
  options.dropped_vertices = vertices_not_of_tooth(record);
  options.compare_as_float = false;
  return check(input, tooth, options);
}

/// Brings the tooth back to where the input is, with evidence for the promises. Far from the origin floats lie so wide
/// apart that new triangles may come to cross each other: then the new vertices keep all their digits.
void put_in_place(const TriangleMesh& fused, const TriangleMesh& input, const std::vector<int>& kept, Workplace place,
                  CompletedTooth& tooth) {
  CompletionRecord& record = tooth.record;
  tooth.mesh = in_input_coordinates(fused, input, kept, place);
  record.promises = evidence(input, tooth.mesh, record);
  if (!record.promises.holds() && place.as_float && !place.origin.isZero(0)) {
    place.as_float = false;
    tooth.mesh = in_input_coordinates(fused, input, kept, place);
    record.promises = evidence(input, tooth.mesh, record);
    record.warnings.push_back(
        "The crown lies so far from the origin that single precision is too coarse for new triangles: new vertices "
        "have double precision. Move the scan to the origin for STL.");
  }
  if (record.promises.holds()) return;
  std::string sentence = "No tooth was found that keeps the promises:";
  for (const std::string& failure : record.promises.failures) sentence += " " + failure;
  throw NoResultError(sentence);
}

/// A crown far from the origin is moved there first, by whole steps of a grid: that rounds no coordinate whose last
/// digit is a part of a step, as all floats' are that lie as far out as the crown; a double or a stray vertex nearer to
/// 0 may lose its last digit, 1e-14 mm. The stages alone work with that: the tooth has the input's own bits. A crown
/// nearby stays, so that its tooth has always the same bits.
Workplace workplace(const TriangleMesh& input, double millimetres_per_unit) {
  constexpr double far_mm = 500, step_mm = 64;
  Workplace place{Point::Zero(), millimetres_per_unit, coordinates_fit_float(input)};
  const std::size_t count = input.vertices.size();
  if (count == 0) return place;
  Point middle;  // the median: a stray vertex somewhere has no say
  for (Eigen::Index k = 0; k < 3; ++k) {
    std::vector<double> along;
    along.reserve(count);
    for (const Point& p : input.vertices)
      if (std::isfinite(p[k])) along.push_back(p[k]);
    if (along.empty()) return place;
    const auto half = along.begin() + static_cast<std::ptrdiff_t>(along.size() / 2);
    std::nth_element(along.begin(), half, along.end());
    middle[k] = *half;
  }
  if (!(middle.norm() * millimetres_per_unit > far_mm)) return place;
  const double step = std::exp2(std::round(std::log2(step_mm / millimetres_per_unit)));
  place.origin = (middle / step).array().round().matrix() * step;
  return place;
}

TriangleMesh moved_by(TriangleMesh mesh, const Eigen::Vector3d& move) {
  if (!move.isZero(0))
    for (Point& p : mesh.vertices) p += move;
  return mesh;
}

/// Whether with these options another part of the crown is kept than `kept_vertices`, and taken for a tooth.
bool takes_another_part(const TriangleMesh& crown_at_work, const CompletionModels::Content& models,
                        const CompleteOptions& options, const std::vector<int>& kept_vertices) {
  try {
    CompletionRecord record;
    const KeptCrown part = take_crown(crown_at_work, models.atlas, models.skirt, options, record);
    if (part.old_vertices == kept_vertices) return false;
    find_frame(part.mesh, models, options, record);
    return true;
  } catch (const Error&) {
    return false;
  }
}

/// `tooth.record` says how far it came where this throws.
void complete_at(const Workplace& place, const TriangleMesh& input, const TriangleMesh& crown_at_work,
                 const CompletionModels::Content& models, StageClock& clock, CompletedTooth& tooth) {
  const CompleteOptions& options = tooth.options;
  CompletionRecord& record = tooth.record;
  clock.begin("crown");
  const KeptCrown crown = take_crown(crown_at_work, models.atlas, models.skirt, options, record);

  clock.begin("frame");
  const CrownFrame found = find_frame(crown.mesh, models, options, record);
  clock.begin("completion network");
  record.model = models.network.metadata();
  FittedSurface fitted;
  const auto makes_a_root = [&](const RootPrediction& tried) {
    clock.begin("orientation");
    const GuidingCloud cloud = assemble_guiding_cloud(crown.mesh, tried.tooth.cloud);
    clock.begin("guiding surface");
    fitted = fitted_guiding_surface(cloud, crown.mesh, options.e);
    const bool is_root = root_tapers(fitted.mesh, crown.mesh, tried.frame);
    if (!is_root) clock.begin("completion network");  // which is asked again
    return is_root;
  };
  RootPrediction prediction = on_part(crown.old_vertices, crown.old_triangles,
                                      [&] { return predict(crown.mesh, found, models, makes_a_root, record); });
  PredictedTooth& predicted = prediction.tooth;
  auto& [surface, fit] = fitted;
  for (std::vector<Point>* points : {&surface.vertices, &predicted.cloud.points})
    steer_root(*points, crown.mesh, prediction.frame.frame, record.fdi, options.steering);
  note_guiding_distance(crown.mesh, surface, record);
  if (fit.undone)
    record.warnings.push_back(fmt::format(
        "Drawn onto the crown the guiding surface would have met itself, so it stays up to {:.2f} mm off the "
        "crown; look at the joint.",
        record.guiding_distance_max));

  clock.begin("joining");
  FuseOptions fuse;
  fuse.transition.width = options.transition;
  const FusedTooth fused = on_part(crown.old_vertices, crown.old_triangles,
                                   [&] { return fuse_crown_and_root(crown.mesh, surface, record.growth_axis, fuse); });
  note_fusion(fused, record);
  note_lengths(crown.mesh, fused.tooth.mesh, record);
  note_uncertainty(crown.mesh, fused.tooth.mesh, predicted, options.steering, tooth);

  clock.begin("check");
  record.frame_centre += options.millimetres_per_unit * place.origin;
  put_in_place(fused.tooth.mesh, input, crown.old_vertices, place, tooth);
  tooth.source.assign(tooth.mesh.vertices.size(), VertexSource::predicted);
  std::fill_n(tooth.source.begin(), crown.old_vertices.size(), VertexSource::scan);
  for (const int v : fused.transition.vertices) tooth.source[static_cast<std::size_t>(v)] = VertexSource::transition;
  record.missed_places = where_promise_three_is_missed(tooth.mesh, crown.old_vertices, crown.mesh.triangles.size(),
                                                       record.promises.new_triangles);
}

/// A refusal names the options that may help.
CompletedTooth complete(const TriangleMesh& input, const CompletionModels::Content& models,
                        const CompleteOptions& options, StageClock& clock) {
  CompletedTooth tooth;
  tooth.options = options;
  const Workplace place = workplace(input, options.millimetres_per_unit);
  const TriangleMesh crown_at_work = moved_by(input, -place.origin);
  const auto hint = [&] {
    return way_out(options, models.skirt.has_value(), [&](const CompleteOptions& other) {
      return takes_another_part(crown_at_work, models, other, tooth.record.kept_vertices);
    });
  };
  try {
    complete_at(place, input, crown_at_work, models, clock, tooth);
  } catch (const InputError& error) {
    throw error.reworded(error.what() + hint());
  } catch (const NoResultError& error) {
    throw NoResultError(error.what() + hint(), error.elements(), error.kind());
  }
  return tooth;
}

}  // namespace

CompletedTooth complete_tooth(const TriangleMesh& crown, const CompletionModels& models, const CompleteOptions& options,
                              const ProgressCallback& progress) {
  require_options_in_range(options);
  const auto completed = [&] {
    StageClock clock(progress);
    CompletedTooth tooth = complete(crown, models.content(), options, clock);
    tooth.record.stages = clock.finish();
    return tooth;
  };
  // An arena is this call's alone: calls side by side keep each their own limit. The networks run on one thread anyhow.
  const int available = tbb::this_task_arena::max_concurrency();
  if (options.threads == 0 || options.threads >= available) return completed();
  tbb::task_arena arena(options.threads);
  return arena.execute(completed);
}

std::vector<CompletedTooth> complete_candidates(const TriangleMesh& crown, const CompletionModels& models, int count,
                                                const CompleteOptions& options, const ProgressCallback& progress) {
  if (count < 1 || count > 9) throw UsageError("There can be 1 to 9 candidates.");
  if (count > 1 && options.steering.any())
    throw UsageError("Candidates differ in what steering sets: ask for one of the two.");
  if (count > 1 && !uncertainty_scales(models.content().network.metadata()))
    throw UsageError("Candidates need a completion network that was calibrated.");
  std::vector<CompletedTooth> candidates{complete_tooth(crown, models, options, progress)};
  if (count == 1) return candidates;
  // A copy: the vector moves its teeth when it grows.
  const RootInterval interval = candidates.front().record.root_interval.value();
  for (int i = 0; i + 1 < count; ++i) {
    CompleteOptions of_this = options;
    const double share = count == 2 ? 0 : static_cast<double>(i) / (count - 2);
    of_this.steering.length_mm = std::lerp(interval.length_low_mm, interval.length_high_mm, share);
    candidates.push_back(complete_tooth(crown, models, of_this, progress));
  }
  return candidates;
}

}  // namespace rhizodont
