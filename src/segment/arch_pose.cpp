// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// S. Umeyama, "Least-squares estimation of transformation parameters between two point patterns", 1991; weights of
// P. J. Huber, "Robust estimation of a location parameter", 1964, found by repeated least squares.
#include "segment/arch_pose.hpp"

#include "mesh/geometry.hpp"
#include "rhizodont/error.hpp"
#include "teeth/fdi.hpp"
#include "teeth/label_numbers.hpp"

#include <fmt/format.h>
#include <Eigen/Geometry>
#include <Eigen/SVD>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

namespace rhizodont {
namespace {

bool is_upper(int fdi) { return jaw_of_fdi(fdi) == Jaw::upper; }

void require_one_jaw(const std::map<int, CrownPlace>& crowns) {
  if (crowns.empty()) throw UsageError("There is no tooth to lay an arch on.");
  for (const auto& [fdi, place] : crowns) {
    if (!is_permanent_tooth(fdi)) throw UsageError(fmt::format("The arch has no place for tooth {}.", fdi));
    if (is_upper(fdi) != is_upper(crowns.begin()->first))
      throw UsageError("Teeth of both jaws cannot lie in one arch.");
  }
}

/// What is to come together: a tooth's middle, and a point above it along its axis.
struct Pair {
  Point model, scan;
  double weight = 1;
};

std::optional<ArchPose> similarity_of(const std::vector<Pair>& pairs) {
  double total = 0;
  Eigen::Vector3d model_mean = Eigen::Vector3d::Zero(), scan_mean = Eigen::Vector3d::Zero();
  for (const Pair& p : pairs) {
    total += p.weight;
    model_mean += p.weight * p.model;
    scan_mean += p.weight * p.scan;
  }
  model_mean /= total;
  scan_mean /= total;
  Eigen::Matrix3d correlation = Eigen::Matrix3d::Zero();
  double spread = 0;
  for (const Pair& p : pairs) {
    correlation += p.weight * (p.scan - scan_mean) * (p.model - model_mean).transpose();
    spread += p.weight * (p.model - model_mean).squaredNorm();
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(correlation, Eigen::ComputeFullU | Eigen::ComputeFullV);
  constexpr double least_spread = 0.01;  // across a row of teeth, of that along it
  if (!(svd.singularValues()(1) > least_spread * svd.singularValues()(0))) return std::nullopt;
  const Eigen::Vector3d sign(1, 1, (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1);
  ArchPose pose;
  pose.rotation = svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
  pose.scale = std::clamp(svd.singularValues().dot(sign) / spread, 0.8, 1.25);
  pose.shift = scan_mean - pose.scale * pose.rotation * model_mean;
  return pose;
}

/// The nearest tooth of the same jaw that is there, on one side of a tooth in the order along the arch.
std::optional<int> neighbour(const std::vector<int>& along, std::size_t i, int step) {
  const auto j = static_cast<std::ptrdiff_t>(i) + step;
  if (j < 0 || j >= static_cast<std::ptrdiff_t>(along.size())) return std::nullopt;
  return along[static_cast<std::size_t>(j)];
}

/// Teeth from the patient's right to the left.
std::vector<int> in_order(const std::map<int, CrownPlace>& crowns) {
  std::vector<int> along;
  for (const auto& [fdi, place] : crowns) along.push_back(fdi);
  const auto position = [](int fdi) { return is_right_side(fdi) ? -(fdi % 10) : fdi % 10; };
  std::sort(along.begin(), along.end(), [&](int a, int b) { return position(a) < position(b); });
  return along;
}

}  // namespace

CrownPlace place_of_crown(const TriangleMesh& open_crown) {
  return {area_centroid(open_crown), area_vector(open_crown), surface_area(open_crown)};
}

std::optional<ArchPose> fit_arch(const ArchModel& model, const std::map<int, CrownPlace>& crowns) {
  require_one_jaw(crowns);
  // mm: as far above its middle as a crown is wide, an axis that leans by 10 degrees counts as a middle 1.5 mm off.
  constexpr double along_axis = 8, axis_weight = 0.5, most_trusted_mm = 1.5;
  std::vector<Pair> pairs;
  for (const auto& [fdi, place] : crowns) {
    const ArchTooth& tooth = model.teeth.at(fdi);
    pairs.push_back({tooth.place, place.middle, 1});
    const double length = place.area_vector.norm();
    if (!(length > 1e-3 * place.area)) continue;  // closed
    pairs.push_back({tooth.place + along_axis * tooth.directions.occlusal,
                     place.middle + along_axis / length * place.area_vector, axis_weight});
  }
  const std::vector<Pair> given = pairs;
  std::optional<ArchPose> pose = similarity_of(pairs);
  constexpr int rounds = 10;
  for (int round = 0; pose && round < rounds; ++round) {
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const double off = (pose->scale * pose->rotation * pairs[i].model + pose->shift - pairs[i].scan).norm();
      pairs[i].weight = given[i].weight * std::min(1.0, most_trusted_mm / std::max(off, 1e-12));
    }
    pose = similarity_of(pairs);
  }
  return pose;
}

std::map<int, ToothDirections> directions_in_arch(const ArchModel& model, const ArchPose& pose,
                                                  const std::map<int, CrownPlace>& crowns) {
  require_one_jaw(crowns);
  // Neighbours further apart than this many places tell little of the arch's line between them.
  constexpr double furthest_mm = 30, most_turn = std::numbers::pi / 6;
  const std::vector<int> along = in_order(crowns);
  const Eigen::Vector3d up = pose.rotation.col(1);
  std::map<int, ToothDirections> directions;
  for (std::size_t i = 0; i < along.size(); ++i) {
    const ArchTooth& tooth = model.teeth.at(along[i]);
    const int before = neighbour(along, i, -1).value_or(along[i]), after = neighbour(along, i, 1).value_or(along[i]);
    const auto level = [&](const Eigen::Vector3d& v) { return Eigen::Vector3d(v - up.dot(v) * up); };
    const Eigen::Vector3d expected =
        level(pose.rotation * (model.teeth.at(after).place - model.teeth.at(before).place));
    const Eigen::Vector3d found = level(crowns.at(after).middle - crowns.at(before).middle);
    double turn = 0;
    if (before != after && found.norm() <= furthest_mm && expected.norm() > 0 && found.norm() > 0)
      turn = std::clamp(std::atan2(up.dot(expected.cross(found)), expected.dot(found)), -most_turn, most_turn);
    const Eigen::Matrix3d to_scan = Eigen::AngleAxisd(turn, up).toRotationMatrix() * pose.rotation;
    ToothDirections here{(to_scan * tooth.directions.occlusal).normalized(), to_scan * tooth.directions.buccal};
    here.buccal = (here.buccal - here.occlusal.dot(here.buccal) * here.occlusal).normalized();
    directions.emplace(along[i], here);
  }
  return directions;
}

}  // namespace rhizodont
