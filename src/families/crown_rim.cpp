// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "families/crown_rim.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace rhizodont {
namespace {

constexpr double full_turn = 2 * std::numbers::pi;

/// The outermost points around the axis, outwards and down at once: there the wall ends and the membrane begins, also
/// where the membrane sags or the wall overhangs.
std::vector<Point> corners_around(const std::vector<Point>& points) {
  constexpr std::size_t sectors = 32;
  constexpr double outward_weight = 0.7;
  std::array<const Point*, sectors> best{};
  std::array<double, sectors> most{};
  for (const Point& p : points) {
    const double turns = std::atan2(p.y(), p.x()) / full_turn + 0.5;
    const std::size_t sector = std::min(sectors - 1, static_cast<std::size_t>(turns * sectors));
    const double value = outward_weight * p.head<2>().norm() - p.z();
    if (best[sector] == nullptr || value > most[sector]) best[sector] = &p, most[sector] = value;
  }
  std::vector<Point> corners;
  for (const Point* p : best)
    if (p != nullptr) corners.push_back(*p);
  return corners;
}

/// Means over neighbouring angles.
CrownRim smoothed_rim(const std::vector<Point>& corners) {
  constexpr double width = 0.16;  // radians
  CrownRim rim;
  for (std::size_t i = 0; i < rim_sectors; ++i) {
    const double angle = full_turn * static_cast<double>(i) / rim_sectors;
    double weights = 0;
    for (const Point& p : corners) {
      const double off = std::remainder(std::atan2(p.y(), p.x()) - angle, full_turn) / width;
      const double weight = std::exp(-0.5 * off * off) + 1e-9;
      weights += weight;
      rim.radius[i] += weight * p.head<2>().norm();
      rim.height[i] += weight * p.z();
    }
    rim.radius[i] /= weights;
    rim.height[i] /= weights;
  }
  return rim;
}

}  // namespace

std::pair<double, double> CrownRim::at(double angle) const {
  double place = angle / full_turn * rim_sectors;
  if (place < 0) place += rim_sectors;
  const double whole = std::floor(place), part = place - whole;
  const std::size_t i = static_cast<std::size_t>(whole) % rim_sectors, j = (i + 1) % rim_sectors;
  return {radius[i] + part * (radius[j] - radius[i]), height[i] + part * (height[j] - height[i])};
}

CrownRim find_rim(const TriangleMesh& crown, const Eigen::Vector3d& up, const Eigen::Vector3d& buccal,
                  Eigen::Isometry3d& frame) {
  constexpr int rounds = 3;  // the rim is found around the axis, which is found from the rim
  Eigen::Vector3d z = up;
  Point origin = Point::Zero();
  for (const Point& p : crown.vertices) origin += p / static_cast<double>(crown.vertices.size());
  std::vector<Point> corners;
  for (int round = 0; round <= rounds; ++round) {
    const Eigen::Vector3d y = (buccal - buccal.dot(z) * z).normalized();
    frame.linear().col(0) = y.cross(z);
    frame.linear().col(1) = y;
    frame.linear().col(2) = z;
    frame.translation() = origin;
    const Eigen::Isometry3d inverse = frame.inverse();
    std::vector<Point> local;
    for (const Point& p : crown.vertices) local.emplace_back(inverse * p);
    corners = corners_around(local);
    if (round == rounds) break;
    Eigen::Vector3d across = Eigen::Vector3d::Zero();
    Point middle = Point::Zero();
    for (std::size_t i = 0; i < corners.size(); ++i) {
      across += corners[i].cross(corners[(i + 1) % corners.size()]);
      middle += corners[i] / static_cast<double>(corners.size());
    }
    origin = frame * middle;
    // Scalloped rims lean; the axis stays near the direction that it is known to have.
    z = (frame.linear() * across.normalized() + 0.7 * up).normalized();
  }
  return smoothed_rim(corners);
}

}  // namespace rhizodont
