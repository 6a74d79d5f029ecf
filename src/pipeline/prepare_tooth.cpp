// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// "Completing Dental Models While Preserving Crown Geometry and Meshing Topology", figure 1: the order of the stages,
// up to the guiding surface.

#include "completion/steering.hpp"
#include "guiding/guiding_cloud.hpp"
#include "intake/part_of_mesh.hpp"
#include "intake/take_crown.hpp"
#include "pipeline/identify_tooth.hpp"
#include "pipeline/prediction.hpp"
#include "pipeline/prepared_tooth.hpp"
#include "pipeline/stage_clock.hpp"
#include "pipeline/way_out.hpp"
#include "rhizodont/complete.hpp"
#include "rhizodont/error.hpp"
#include "teeth/fdi.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace rhizodont {
namespace {

CrownRecord crown_record(const TriangleMesh& input, const TakenCrown& taken) {
  CrownRecord record;
  record.triangles = static_cast<int>(input.triangles.size());
  record.kept_triangles = static_cast<int>(taken.kept.mesh.triangles.size());
  record.cap_dropped = taken.record.cap_dropped;
  record.kept_vertices = taken.kept.old_vertices;
  std::sort(record.kept_vertices.begin(), record.kept_vertices.end());
  record.dropped_vertices = taken.kept.dropped;
  record.tooth_confidence = taken.record.tooth_confidence;
  return record;
}

/// What the user is to know of where the root comes from.
std::optional<std::string> source_warning(RootSource source, int fdi) {
  if (source == RootSource::network_laid_anew)
    return "The first prediction of the root fell to pieces; the crown was laid anew. Look at the root, and check the "
           "tooth's number.";
  if (source == RootSource::mean_tooth)
    return fmt::format(
        "No root could be predicted from this crown; it has that of a mean {}, and nothing of its own. Check the "
        "tooth's number and whether the crown is whole.",
        fdi);
  return std::nullopt;
}

/// A prediction with the guiding surface made of it.
struct Root {
  RootPrediction prediction;
  FittedSurface surface;
};

Root find_root(const PreparedCrown& crown, const IdentifiedTooth& tooth, const CompletionModels::Content& models,
               double e, StageClock& clock) {
  Root root;
  const auto makes_a_root = [&](const RootPrediction& tried) {
    clock.begin("orientation");
    const GuidingCloud cloud = assemble_guiding_cloud(crown, tried.tooth.cloud);
    clock.begin("guiding surface");
    root.surface = fitted_guiding_surface(cloud, crown, e);
    const bool is_root = root_tapers(root.surface.mesh, crown.mesh, tried.frame);
    if (!is_root) clock.begin("completion network");  // which is asked again
    return is_root;
  };
  root.prediction = predict_tooth(crown.mesh, tooth.fdi, tooth.frame, models, makes_a_root);
  return root;
}

/// What the tooth will keep, with the input's numbers.
TakenCrown take_at_workplace(const TriangleMesh& crown_at_work, const Workplace& place,
                             const CompletionModels::Content& models, const CompleteOptions& options) {
  return on_part(place.order.vertices, place.order.triangles, [&] {
    TakenCrown taken = take_crown(crown_at_work, models.atlas, models.skirt, options);
    number_as_input(taken, place);
    return taken;
  });
}

/// `kept_vertices`: says how far it came where this throws.
std::shared_ptr<PreparedTooth::Content> prepare(const TriangleMesh& input, const Workplace& place,
                                                const TriangleMesh& crown_at_work,
                                                std::shared_ptr<const CompletionModels::Content> shared_models,
                                                const CompleteOptions& options, StageClock& clock,
                                                std::vector<int>& kept_vertices) {
  const CompletionModels::Content& models = *shared_models;
  clock.begin("crown");
  TakenCrown taken = take_at_workplace(crown_at_work, place, models, options);
  kept_vertices = taken.kept.old_vertices;
  CompletionRecord record;
  record.millimetres_per_unit = options.millimetres_per_unit;
  record.crown = crown_record(input, taken);
  record.repairs = std::move(taken.record.repairs);
  record.skirt_model = std::move(taken.record.skirt_model);
  PreparedCrown crown = prepare_crown(std::move(taken.kept.mesh));
  const std::optional<ToothDirections> directions = at_workplace(options.directions, place);
  if (directions) crown.growth_axis = axis_in_arch(crown.growth_axis, directions->occlusal);

  clock.begin("frame");
  const IdentifiedTooth tooth = identify_tooth(crown, options.fdi, directions, models);
  record.fdi = tooth.fdi;
  record.fdi_guessed = tooth.guessed;
  record.likeness = tooth.likeness;
  if (tooth.warning) record.warnings.push_back(*tooth.warning);

  clock.begin("completion network");
  record.model = models.network.metadata();
  Root root = on_part(taken.kept.old_vertices, taken.kept.old_triangles,
                      [&] { return find_root(crown, tooth, models, options.e, clock); });
  record.frame = in_input_coordinates(root.prediction.frame, place);
  record.root.source = root.prediction.source;
  if (auto warning = source_warning(root.prediction.source, tooth.fdi)) record.warnings.push_back(*std::move(warning));
  record.stages = clock.finish();
  return std::make_shared<PreparedTooth::Content>(
      PreparedTooth::Content{std::move(shared_models), options, std::move(record), input, place,
                             std::move(taken.kept.old_vertices), std::move(taken.kept.old_triangles), std::move(crown),
                             root.prediction.frame.frame, std::move(root.prediction.tooth), std::move(root.surface)});
}

/// Whether with these options another part of the crown is kept than `kept_vertices`, and taken for a tooth.
bool takes_another_part(const TriangleMesh& crown_at_work, const Workplace& place,
                        const CompletionModels::Content& models, const CompleteOptions& options,
                        const std::vector<int>& kept_vertices) {
  try {
    TakenCrown part = take_at_workplace(crown_at_work, place, models, options);
    if (part.kept.old_vertices == kept_vertices) return false;
    identify_tooth(prepare_crown(std::move(part.kept.mesh)), options.fdi, at_workplace(options.directions, place),
                   models);
    return true;
  } catch (const Error&) {
    return false;
  }
}

}  // namespace

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
  if (options.directions) {
    constexpr double tolerance = 0.02;
    const auto& [occlusal, buccal] = *options.directions;
    if (!(std::abs(occlusal.norm() - 1) < tolerance && std::abs(buccal.norm() - 1) < tolerance &&
          std::abs(occlusal.dot(buccal)) < tolerance))
      throw UsageError("The tooth's directions must be of unit length and at right angles to each other.");
  }
  require_steering_in_range(options.steering);
}

std::string hint_at_options(const TriangleMesh& crown_at_work, const Workplace& place,
                            const CompletionModels::Content& models, const CompleteOptions& options,
                            const std::vector<int>& kept_vertices) {
  return way_out(options, models.skirt.has_value(), [&](const CompleteOptions& other) {
    return takes_another_part(crown_at_work, place, models, other, kept_vertices);
  });
}

PreparedTooth::PreparedTooth(std::shared_ptr<const Content> content) : content_(std::move(content)) {}

const CompletionRecord& PreparedTooth::record() const { return content_->record; }

const CompleteOptions& PreparedTooth::options() const { return content_->options; }

std::shared_ptr<PreparedTooth::Content> prepared_content(const TriangleMesh& crown, const CompletionModels& models,
                                                         const CompleteOptions& options,
                                                         const ProgressCallback& progress) {
  require_options_in_range(options);
  return with_threads(options.threads, [&] {
    StageClock clock(progress);
    const Workplace place = workplace(crown, options.millimetres_per_unit, options.directions);
    const TriangleMesh crown_at_work = at_workplace(crown, place);
    std::vector<int> kept_vertices;
    const auto work = [&] {
      return prepare(crown, place, crown_at_work, content_of(models), options, clock, kept_vertices);
    };
    const auto hint = [&] {
      return hint_at_options(crown_at_work, place, *content_of(models), options, kept_vertices);
    };
    return letting_callbacks_throw([&] { return hinting(work, hint); });
  });
}

PreparedTooth prepare_tooth(const TriangleMesh& crown, const CompletionModels& models, const CompleteOptions& options,
                            const ProgressCallback& progress) {
  return PreparedTooth(prepared_content(crown, models, options, progress));
}

}  // namespace rhizodont
