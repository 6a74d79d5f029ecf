// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "learning/vary_cloud.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "networks/cloud_grid.hpp"

namespace rhizodont {
namespace {

Eigen::Vector3f row(const std::vector<float>& values, std::size_t i) {
  return {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
}

void append_to(std::vector<float>& values, const Eigen::Vector3f& v) {
  values.insert(values.end(), v.begin(), v.end());
}

Eigen::Vector3f any_direction(RandomStream& random) {
  return Eigen::Vector3d(random.normal(), random.normal(), random.normal()).normalized().cast<float>();
}

/// Which points are shown: all, a part of the arch, those near teeth.
std::vector<std::size_t> shown_points(const LabelledCloud& scan, const ScanVariation& v, RandomStream& random) {
  const std::size_t n = scan.cloud.size();
  std::vector<bool> shown(n, true);
  if (random.chance(v.crop_share)) {
    const auto angle = static_cast<float>(random.uniform(0, 2 * std::numbers::pi));
    const Eigen::Vector3f across(std::cos(angle), std::sin(angle), 0);
    std::vector<float> along;
    for (std::size_t i = 0; i < n; ++i) along.push_back(across.dot(row(scan.cloud.positions, i)));
    std::vector<float> sorted = along;
    const auto at = static_cast<std::ptrdiff_t>(random.uniform(0.05, 0.5) * static_cast<double>(n));
    std::nth_element(sorted.begin(), sorted.begin() + at, sorted.end());
    for (std::size_t i = 0; i < n; ++i) shown[i] = along[i] >= sorted[static_cast<std::size_t>(at)];
  }
  if (random.chance(v.trim_share)) {
    std::vector<float> teeth;
    for (std::size_t i = 0; i < n; ++i)
      if (scan.teeth[i] != 0) append_to(teeth, row(scan.cloud.positions, i));
    if (!teeth.empty()) {
      const auto far = static_cast<float>(std::exp(random.uniform(std::log(1.5), std::log(15.0))));
      const CloudGrid grid(teeth, 2);
      const std::vector<std::int32_t> near = grid.nearest(scan.cloud.positions, 1);
      for (std::size_t i = 0; i < n; ++i)
        if ((row(teeth, static_cast<std::size_t>(near[i])) - row(scan.cloud.positions, i)).norm() > far)
          shown[i] = false;
    }
  }
  std::vector<std::size_t> points;
  for (std::size_t i = 0; i < n; ++i)
    if (shown[i]) points.push_back(i);
  if (points.size() < 500) {
    points.resize(n);
    for (std::size_t i = 0; i < n; ++i) points[i] = i;
  }
  return points;
}

/// Smooth displacements.
class Bending {
 public:
  Bending(double slope, RandomStream& random) {
    for (Wave& w : waves_) {
      const double length = random.uniform(12, 60);
      w.frequency = any_direction(random) * static_cast<float>(2 * std::numbers::pi / length);
      w.way = any_direction(random) * static_cast<float>(slope * length / 6 * random.normal());
      w.phase = static_cast<float>(random.uniform(0, 2 * std::numbers::pi));
    }
  }
  Eigen::Vector3f operator()(const Eigen::Vector3f& p) const {
    Eigen::Vector3f sum = p;
    for (const Wave& w : waves_) sum += std::sin(w.frequency.dot(p) + w.phase) * w.way;
    return sum;
  }

 private:
  struct Wave {
    Eigen::Vector3f frequency, way;
    float phase;
  };
  std::array<Wave, 6> waves_;
};

Eigen::Matrix3f drawn_turn(const ScanVariation& v, RandomStream& random) {
  const double turn =
      random.chance(v.any_turn_share) ? random.uniform(0, 2 * std::numbers::pi) : v.turn * random.normal();
  const double tilt = v.tilt * std::abs(random.normal()) * (random.chance(v.strong_tilt_share) ? 3 : 1);
  const double about = random.uniform(0, 2 * std::numbers::pi);
  const Eigen::Vector3d axis(std::cos(about), std::sin(about), 0);
  const Eigen::Matrix3d rotation = Eigen::AngleAxisd(std::min(tilt, 0.8), axis).toRotationMatrix() *
                                   Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return rotation.cast<float>();
}

void label(ShownScan& shown, const std::vector<std::uint8_t>& teeth, bool mirrored, const ScanCloud& cloud) {
  const std::vector<std::int32_t>& chosen = shown.pyramid.levels[0].from;
  std::map<int, std::pair<Eigen::Vector3d, double>> sums;
  for (std::size_t i = 0; i < teeth.size(); ++i) {
    auto& [sum, count] = sums.try_emplace(teeth[i], Eigen::Vector3d::Zero(), 0).first->second;
    sum += row(cloud.positions, i).cast<double>();
    ++count;
  }
  const std::vector<float>& positions = shown.pyramid.levels[0].positions;
  const CloudGrid grid(cloud.positions, scan_border_mm);
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    const int tooth = teeth[static_cast<std::size_t>(chosen[i])];
    const int kind = scan_kind(tooth, shown.upper);
    shown.kinds.push_back(mirrored ? mirrored_kind(kind) : kind);
    const Eigen::Vector3f p = row(positions, i);
    Eigen::Vector3f way = Eigen::Vector3f::Zero();
    if (tooth != 0) way = (sums.at(tooth).first / sums.at(tooth).second).cast<float>() - p;
    append_to(shown.middles, way / scan_offset_mm);
    bool border = false;
    grid.visit_near(p.data(), scan_border_mm, [&](std::int32_t j) {
      const auto k = static_cast<std::size_t>(j);
      border = border ||
               (teeth[k] != tooth && (row(cloud.positions, k) - p).squaredNorm() < scan_border_mm * scan_border_mm);
    });
    shown.borders.push_back(border ? 1 : 0);
  }
}

}  // namespace

ShownScan varied(const LabelledCloud& scan, const ScanShape& shape, const ScanVariation& v, RandomStream& random) {
  const std::vector<std::size_t> points = shown_points(scan, v, random);
  const bool mirrored = random.chance(0.5);
  const Bending bending(v.bend, random);
  const Eigen::Matrix3f rotation = drawn_turn(v, random);
  const double size = v.size * random.normal();
  Eigen::Vector3f stretch;
  for (float& s : stretch) s = static_cast<float>(std::exp(size + 0.6 * v.size * random.normal()));
  if (mirrored) stretch.x() = -stretch.x();
  const auto noise = static_cast<float>(v.noise_mm * random.uniform(0, 2));
  const auto disturbed = [&](Eigen::Vector3f p, float by) {
    for (float& x : p) x += by * static_cast<float>(random.normal());
    return p;
  };
  ScanCloud cloud;
  std::vector<std::uint8_t> teeth;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const std::size_t i : points) {
    const Eigen::Vector3f p = bending(row(scan.cloud.positions, i)).cwiseProduct(stretch);
    const Eigen::Vector3f moved = rotation * disturbed(p, noise);
    mean += moved.cast<double>() / static_cast<double>(points.size());
    append_to(cloud.positions, moved);
    const Eigen::Vector3f normal = row(scan.cloud.normals, i).cwiseQuotient(stretch).normalized();
    append_to(cloud.normals, disturbed(rotation * normal, 2 * noise).normalized());
    for (std::size_t c = 0; c < scan_curvature_count; ++c)
      cloud.curvatures.push_back(scan.cloud.curvatures[scan_curvature_count * i + c] +
                                 noise * static_cast<float>(random.normal()));
    teeth.push_back(scan.teeth[i]);
  }
  const Eigen::Vector3f shift = disturbed(-mean.cast<float>(), static_cast<float>(10 * v.tilt));
  for (std::size_t i = 0; i < cloud.size(); ++i)
    for (std::size_t a = 0; a < 3; ++a) cloud.positions[3 * i + a] += shift[static_cast<Eigen::Index>(a)];
  ShownScan shown;
  shown.upper = scan.upper;
  shown.pyramid = scan_pyramid(cloud, shape);
  label(shown, teeth, mirrored, cloud);
  for (Eigen::Index a = 0; a < 3; ++a) {
    shown.front[static_cast<std::size_t>(a)] = rotation(a, 1);
    shown.occlusal[static_cast<std::size_t>(a)] = rotation(a, 2);
  }
  return shown;
}

}  // namespace rhizodont
