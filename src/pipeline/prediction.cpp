// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "pipeline/prediction.hpp"

#include "mesh/geometry.hpp"
#include "mesh/nearest_vertex.hpp"
#include "mesh/sampling.hpp"
#include "rhizodont/error.hpp"
#include "teeth/fdi.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <numbers>
#include <vector>

namespace rhizodont {
namespace {

Eigen::Vector3d axis_of(const CrownFrame& frame) { return frame.frame.direction_to_world(Eigen::Vector3d::UnitZ()); }

/// Turned about the canonical z axis.
CrownFrame turned(const CrownFrame& frame, double radians) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(radians, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  CrownFrame result = frame;
  result.frame.rotation = turn * frame.frame.rotation;
  result.form_axis.setZero();  // it was found for the other turn
  return result;
}

RigidFit mean_crown_on(const TriangleMesh& crown, int fdi, const CrownFrame& frame, const MeanCrown& mean) {
  const SurfaceSamples samples = sample_surface(crown, 1500, 1);
  return fit_mean_crown({samples.points, samples.normals}, mean, is_right_side(fdi), false, axis_of(frame));
}

/// The crown stood upright as its type's mean crown stands on it.
CrownFrame upright_by_form(const TriangleMesh& crown, const RigidFit& fit) {
  CrownFrame frame;
  frame.frame = fit.frame;
  frame.frame.centre = area_centroid(crown);
  frame.residual_mm = fit.residual_mm;
  return frame;
}

/// As many distinct points as the network asks for on a mean crown that has fewer: others a third of the way to a
/// point's neighbours.
std::vector<Eigen::Vector3f> network_input(const MeanCrown& mean, std::size_t count) {
  std::vector<Point> points = mean.crown.points;
  const NearestVertexIndex index(mean.crown.points);
  for (std::size_t neighbour = 1; points.size() < count && neighbour < 6; ++neighbour)
    for (std::size_t i = 0; i < mean.crown.points.size() && points.size() < count; ++i) {
      const auto near = index.nearest(mean.crown.points[i], neighbour + 1);
      const Point& other = mean.crown.points[static_cast<std::size_t>(near[neighbour].index)];
      points.push_back(mean.crown.points[i] + (other - mean.crown.points[i]) / 3);
    }
  std::vector<Eigen::Vector3f> input;
  for (const Point& p : points) input.push_back(p.cast<float>());
  return input;
}

/// What the network sees in the mean crown of the type, carried to where that lies on the crown.
PredictedTooth mean_tooth_on(int fdi, const RigidFit& fit, const CompletionModels::Content& models) {
  constexpr double least_expected_mm = 3;  // roots of one type differ by 1 to 2 mm in length; the rest is the laying
  const int type = tooth_type_of_fdi(fdi);
  const MeanCrown& mean = models.atlas.types[static_cast<std::size_t>(type)];
  const CompletedPoints completed = models.network.complete(
      network_input(mean, static_cast<std::size_t>(models.network.input_points())), type, Eigen::Vector2f::Zero());
  CanonicalFrame frame = fit.frame;
  frame.scale *= fit.scale_ratio;
  PredictedTooth tooth;
  for (std::size_t i = 0; i < completed.points.size(); ++i) {
    tooth.cloud.points.push_back(frame.to_world(completed.points[i].cast<double>()));
    tooth.cloud.normals.push_back(frame.direction_to_world(completed.normals[i].cast<double>()).normalized());
    tooth.expected_distance.push_back(
        std::max(least_expected_mm, frame.scale * static_cast<double>(completed.spread[i])));
  }
  return tooth;
}

Solidity root_solidity(const TriangleMesh& crown, const PredictedTooth& tooth, const CrownFrame& frame) {
  const Eigen::Vector3d axis = axis_of(frame);
  return solidity(tooth, axis, extent_along(crown.vertices, axis).first);
}

}  // namespace

RootPrediction predict_tooth(const TriangleMesh& crown, int fdi, const CrownFrame& frame,
                             const CompletionModels::Content& models,
                             const std::function<bool(const RootPrediction&)>& makes_a_root) {
  const auto predict = [&](const CrownFrame& pose, RootSource source) {
    RootPrediction prediction{complete_points(crown, fdi, pose, models.network), pose, source, {}};
    prediction.solidity = root_solidity(crown, prediction.tooth, pose);
    return prediction;
  };
  RootPrediction best = predict(frame, RootSource::network);
  if (is_solid(best.solidity) && makes_a_root(best)) return best;
  const MeanCrown& mean = models.atlas.types[static_cast<std::size_t>(tooth_type_of_fdi(fdi))];
  const RigidFit fit = mean_crown_on(crown, fdi, frame, mean);
  const CrownFrame by_form = upright_by_form(crown, fit);
  std::vector<CrownFrame> poses;
  for (const double turns : {0.5, 0.25, 0.75}) poses.push_back(turned(frame, 2 * std::numbers::pi * turns));
  // What was laid on its side, or upside down, is no better than the border.
  constexpr double least_agreement = 0.6;
  const bool laid_well = axis_of(by_form).dot(axis_of(frame)) > least_agreement;
  if (laid_well) {
    poses.push_back(by_form);
    poses.push_back(turned(by_form, std::numbers::pi));
  }
  std::vector<RootPrediction> others;
  for (const CrownFrame& pose : poses) {
    RootPrediction other = predict(pose, RootSource::network_laid_anew);
    if (is_solid(other.solidity)) others.push_back(std::move(other));
  }
  std::stable_sort(others.begin(), others.end(), [](const RootPrediction& a, const RootPrediction& b) {
    return shreds(a.solidity) < shreds(b.solidity);
  });
  for (RootPrediction& other : others)
    if (makes_a_root(other)) return std::move(other);
  RootPrediction fallback{mean_tooth_on(fdi, fit, models), by_form, RootSource::mean_tooth, {}};
  fallback.solidity = root_solidity(crown, fallback.tooth, by_form);
  if (!laid_well || !is_solid(fallback.solidity) || !makes_a_root(fallback))
    throw NoResultError(
        "No root can be predicted from this crown: neither the network's root nor a mean one fits it. Check the "
        "tooth's "
        "number, and whether the crown is whole and stands on its own open base.");
  return fallback;
}

bool root_tapers(const TriangleMesh& surface, const TriangleMesh& crown, const CrownFrame& frame) {
  constexpr double most_swelling = 1.25;  // far from both kinds: see `swelling`
  const Eigen::Vector3d axis = axis_of(frame);
  return swelling(surface, axis, extent_along(crown.vertices, axis).first) <= most_swelling;
}

}  // namespace rhizodont
