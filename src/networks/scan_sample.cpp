// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "networks/scan_sample.hpp"

#include "networks/cloud_grid.hpp"
#include "rhizodont/error.hpp"

#include <algorithm>
#include <cmath>

namespace rhizodont {
namespace {

constexpr float far_mm = 25;

std::vector<float> rows(const std::vector<float>& values, const std::vector<std::int32_t>& chosen, std::size_t width) {
  std::vector<float> result;
  result.reserve(chosen.size() * width);
  for (const std::int32_t i : chosen) {
    const auto begin = values.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(i) * width);
    result.insert(result.end(), begin, begin + static_cast<std::ptrdiff_t>(width));
  }
  return result;
}

/// The nearer, the more.
void weigh(const ScanLevel& fine, const ScanLevel& coarse, std::vector<float>& weights) {
  weights.resize(fine.above.size());
  for (std::size_t i = 0; i < fine.size(); ++i) {
    float sum = 0;
    for (std::size_t j = 3 * i; j < 3 * i + 3; ++j) {
      float squared = 1e-4F;
      for (std::size_t a = 0; a < 3; ++a) {
        const float d = fine.positions[3 * i + a] - coarse.positions[3 * static_cast<std::size_t>(fine.above[j]) + a];
        squared += d * d;
      }
      weights[j] = 1 / squared;
      sum += weights[j];
    }
    for (std::size_t j = 3 * i; j < 3 * i + 3; ++j) weights[j] /= sum;
  }
}

/// Turns the vectors that begin every `width` numbers from `first` on.
void turn_vectors(const Eigen::Matrix3d& rotation, std::vector<float>& values, std::size_t first, std::size_t width) {
  const Eigen::Matrix3f turn = rotation.cast<float>();
  for (std::size_t i = first; i + 2 < values.size(); i += width) {
    Eigen::Map<Eigen::Vector3f> v(values.data() + i);
    v = (turn * v).eval();
  }
}

}  // namespace

void turn(const Eigen::Matrix3d& rotation, ScanCloud& cloud) {
  turn_vectors(rotation, cloud.positions, 0, 3);
  turn_vectors(rotation, cloud.normals, 0, 3);
}

void turn(const Eigen::Matrix3d& rotation, ScanPyramid& pyramid) {
  for (ScanLevel& level : pyramid.levels) {
    turn_vectors(rotation, level.positions, 0, 3);
    turn_vectors(rotation, level.normals, 0, 3);
  }
  for (const std::size_t first : {0, 3}) turn_vectors(rotation, pyramid.features, first, scan_feature_count);
}

ScanPyramid scan_pyramid(const ScanCloud& cloud, const ScanShape& shape) {
  check_scan_shape(shape);
  const std::size_t n = cloud.size();
  if (n == 0 || cloud.positions.size() != 3 * n || cloud.normals.size() != 3 * n ||
      cloud.curvatures.size() != scan_curvature_count * n)
    throw InputError("The arrays of a scan's points do not fit each other.");
  for (const auto* values : {&cloud.positions, &cloud.normals, &cloud.curvatures})
    if (!std::all_of(values->begin(), values->end(), [](float x) { return std::isfinite(x); }))
      throw InputError("A scan's points have values that are not finite.");
  ScanPyramid pyramid;
  for (std::size_t l = 0; l < ScanShape::levels; ++l) {
    const auto& positions = l == 0 ? cloud.positions : pyramid.levels[l - 1].positions;
    const auto& normals = l == 0 ? cloud.normals : pyramid.levels[l - 1].normals;
    const float spacing = 1e-3F * static_cast<float>(shape.spacings_um[l]);
    ScanLevel& level = pyramid.levels[l];
    level.from = thinned(positions, spacing);
    level.positions = rows(positions, level.from, 3);
    level.normals = rows(normals, level.from, 3);
    const CloudGrid grid(level.positions, 1.3F * spacing);
    level.neighbours = grid.nearest(level.positions, shape.neighbours);
    if (l == 0) continue;
    ScanLevel& finer = pyramid.levels[l - 1];
    const CloudGrid fine_grid(finer.positions, 1.3e-3F * static_cast<float>(shape.spacings_um[l - 1]));
    level.below = fine_grid.nearest(level.positions, shape.neighbours);
    finer.above = grid.nearest(finer.positions, 3);
    weigh(finer, level, finer.above_weights);
  }
  const std::vector<std::int32_t>& chosen = pyramid.levels[0].from;
  pyramid.features.reserve(chosen.size() * scan_feature_count);
  for (const std::int32_t i : chosen) {
    const auto p = static_cast<std::size_t>(i);
    for (std::size_t a = 0; a < 3; ++a) pyramid.features.push_back(cloud.positions[3 * p + a] / far_mm);
    for (std::size_t a = 0; a < 3; ++a) pyramid.features.push_back(cloud.normals[3 * p + a]);
    for (std::size_t a = 0; a < scan_curvature_count; ++a)
      pyramid.features.push_back(cloud.curvatures[scan_curvature_count * p + a]);
  }
  return pyramid;
}

}  // namespace rhizodont
