// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "poses.hpp"

#include "base/parallel_tasks.hpp"
#include "evaluation/held_out_people.hpp"
#include "families/crown_crop.hpp"
#include "mesh/geometry.hpp"
#include "mesh/nearest_vertex.hpp"
#include "mesh/sampling.hpp"
#include "pipeline/identify_tooth.hpp"
#include "pipeline/models.hpp"
#include "pipeline/prediction.hpp"
#include "rhizodont/error.hpp"
#include "teeth/fdi.hpp"
#include "teeth/prepared_crown.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <optional>
#include <vector>

namespace rhizodont {
namespace {

constexpr double degrees = 180 / std::numbers::pi;

/// Distances of two clouds of points, mean of both ways.
struct Distances {
  double mean = 0;    ///< mm
  double square = 0;  ///< mm^2
};

struct Outcome {
  double turn = 0, lean = 0, lean_off = 0;  ///< degrees
  Distances laid, true_pose;
};

Distances one_way(const std::vector<Point>& from, const NearestVertexIndex& to) {
  Distances sum;
  const auto count = static_cast<double>(from.size());
  for (const Point& p : from) {
    const double squared = to.nearest(p).squared_distance;
    sum.mean += std::sqrt(squared) / count, sum.square += squared / count;
  }
  return sum;
}

Distances between(const std::vector<Point>& a, const std::vector<Point>& b) {
  const Distances there = one_way(a, NearestVertexIndex(b)), back = one_way(b, NearestVertexIndex(a));
  return {(there.mean + back.mean) / 2, (there.square + back.square) / 2};
}

Outcome lay_and_predict(const ToothFamilies& families, const CompletionModels& models, const PersonDraw& person,
                        int type) {
  constexpr double overlap_mm = 1;
  constexpr std::size_t samples = 6000;
  const CompletionModels::Content& content = *content_of(models);
  const int fdi = fdi_of_type(type, false);
  const SyntheticTooth tooth = held_out_tooth(families, person, type);
  const TriangleMesh crown = held_out_crown(tooth, person);
  const CrownFrame laid = lay_crown(prepare_crown(crown), fdi, {}, content);
  CrownFrame truth = laid;
  truth.frame.rotation = frame_of_crop(crown, -tooth.crown_turn).rotation;
  truth.form_axis = truth.frame.direction_to_canonical(tooth.crown_axis).head<2>();

  Outcome outcome;
  const Eigen::Matrix3d r = laid.frame.rotation * truth.frame.rotation.transpose();
  outcome.turn = degrees * std::abs(std::atan2(r(1, 0) - r(0, 1), r(0, 0) + r(1, 1)));
  outcome.lean = degrees * std::asin(std::min(1.0, truth.form_axis.norm()));
  const Eigen::Vector3d said = laid.frame.direction_to_world(laid.form_direction());
  outcome.lean_off = degrees * std::acos(std::clamp(said.dot(tooth.crown_axis), -1.0, 1.0));
  truth.form_axis *=
      std::min(1.0, CrownFrame::longest_form_axis / std::max(1e-9, truth.form_axis.norm()));  // as `CrownFrame` has it

  const Eigen::Vector3d up = crown_growth_axis(crown);
  const double level = extent_along(crown.vertices, up).first + overlap_mm;
  const auto below = [&](std::vector<Point> points) {
    std::erase_if(points, [&](const Point& p) { return p.dot(up) > level; });
    return points;
  };
  const std::vector<Point> root = below(sample_surface(tooth.mesh, samples, 1).points);
  const auto from = [&](const CrownFrame& pose) {
    const auto any = [](const RootPrediction&) { return true; };
    return between(below(predict_tooth(crown, fdi, pose, content, any).tooth.cloud.points), root);
  };
  outcome.laid = from(laid);
  outcome.true_pose = from(truth);
  return outcome;
}

}  // namespace

void print_poses(const ToothFamilies& families, const CompletionModels& models, std::size_t people) {
  constexpr double lost = 30;  // degrees
  constexpr std::array<double, 5> bounds{0, 10, 20, 30, 90};
  std::vector<std::optional<Outcome>> outcomes(people * tooth_type_count);
  parallel_tasks(outcomes.size(), [&](std::size_t i) {
    try {
      const PersonDraw person = held_out_person(HeldOutPeople::for_figures, i / tooth_type_count);
      outcomes[i] = lay_and_predict(families, models, person, static_cast<int>(i % tooth_type_count));
    } catch (const UsageError&) {
      throw;
    } catch (const Error&) {
      // no crown came off, or no root could be predicted
    }
  });
  fmt::print(
      "\n## Poses\n\n{} people. Lean: of the border's axis against the form's. Lost: turned by over 30 degrees about "
      "the "
      "axis. Points below the border; in brackets with the true pose.\n\n| lean, degrees | crowns | lost | turn off, "
      "degrees, others | lean off, degrees | Chamfer, mm | squared, mm2 |\n|---|---|---|---|---|---|---|\n",
      people);
  const auto row = [&](const std::string& name, double low, double high) {
    Outcome sum;
    double count = 0, lost_count = 0;
    for (const std::optional<Outcome>& o : outcomes) {
      if (!o || o->lean < low || o->lean >= high) continue;
      ++count;
      o->turn > lost ? lost_count += 1 : sum.turn += o->turn;
      sum.lean_off += o->lean_off;
      sum.laid.mean += o->laid.mean, sum.laid.square += o->laid.square;
      sum.true_pose.mean += o->true_pose.mean, sum.true_pose.square += o->true_pose.square;
    }
    if (count == 0) return;
    fmt::print("| {} | {} | {:.1f} % | {:.1f} | {:.1f} | {:.3f} ({:.3f}) | {:.3f} ({:.3f}) |\n", name, count,
               100 * lost_count / count, sum.turn / std::max(1.0, count - lost_count), sum.lean_off / count,
               sum.laid.mean / count, sum.true_pose.mean / count, sum.laid.square / count,
               sum.true_pose.square / count);
  };
  for (std::size_t b = 0; b + 1 < bounds.size(); ++b)
    row(b + 2 == bounds.size() ? fmt::format("over {}", bounds[b]) : fmt::format("{} to {}", bounds[b], bounds[b + 1]),
        bounds[b], bounds[b + 1]);
  row("all", bounds.front(), bounds.back() + 1);
  std::fflush(stdout);
}

}  // namespace rhizodont
