// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// Roots turned, bent and stretched after the prediction. The bend is that of A. Barr, "Global and local deformations of
// solid primitives", 1984, along a centre line whose direction is given by depth.
#include "completion/steering.hpp"

#include "mesh/border_pieces.hpp"
#include "mesh/smooth_functions.hpp"
#include "rhizodont/error.hpp"
#include "teeth/fdi.hpp"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace rhizodont {
namespace {

void require_angle(double degrees, double most, const char* name) {
  if (!(std::abs(degrees) <= most))
    throw UsageError(fmt::format("A root {} of {} degrees is out of its range, -{} to {}.", name, degrees, most, most));
}

/// Where the root starts and which way is which, in the frame of the crown's file.
struct RootFrame {
  Point start = Point::Zero();  ///< middle of the base, at the crown's lowest level
  Eigen::Vector3d down, distal, lingual;
};

RootFrame root_frame(const TriangleMesh& crown, const CanonicalFrame& frame, int fdi) {
  RootFrame root;
  root.down = -frame.direction_to_world(Eigen::Vector3d::UnitZ());
  const double to_distal = tooth_type_of_fdi(fdi) < 8 ? 1 : -1;  // +x is distal for upper and mesial for lower teeth
  root.distal = frame.direction_to_world(to_distal * Eigen::Vector3d::UnitX());
  root.lingual = frame.direction_to_world(-Eigen::Vector3d::UnitY());
  double deepest = std::numeric_limits<double>::lowest();
  for (const Triangle& t : crown.triangles)
    for (const int v : t) deepest = std::max(deepest, crown.vertices[static_cast<std::size_t>(v)].dot(root.down));
  const std::vector<BorderPiece> border = border_pieces(crown);
  if (border.empty()) throw InputError("A closed crown has no border where a root could start.");
  const std::vector<int>& base = border[base_piece(border)].vertices;
  for (const int v : base) root.start += crown.vertices[static_cast<std::size_t>(v)];
  root.start /= static_cast<double>(base.size());
  root.start += (deepest - root.start.dot(root.down)) * root.down;
  return root;
}

/// The centre line of the bent root by depth: place and rotation every `step` mm.
struct CentreLine {
  static constexpr double step = 0.05;
  std::vector<Point> places;
  double depth = 0;
  RootFrame frame;
  RootSteering steering;

  Eigen::Quaterniond turn(double d) const {
    constexpr double start = 3;  // mm over which the root turns away from the crown
    constexpr double radians = std::numbers::pi / 180;
    const double begun = smooth_step(d / std::min(start, depth));
    const double to_distal = steering.tip_degrees * begun + steering.bend_degrees * smooth_step(2 * d / depth - 1);
    const Eigen::Vector3d towards =
        radians * (to_distal * frame.distal + steering.torque_degrees * begun * frame.lingual);
    const double angle = towards.norm();
    if (angle == 0) return Eigen::Quaterniond::Identity();
    return Eigen::Quaterniond(Eigen::AngleAxisd(angle, frame.down.cross(towards).normalized()));
  }

  CentreLine(const RootFrame& given, const RootSteering& wishes, double root_depth)
      : depth(root_depth), frame(given), steering(wishes) {
    places.push_back(frame.start);
    for (double d = 0; d < depth + step; d += step)
      places.push_back(places.back() + step * (turn(d + 0.5 * step) * frame.down));
  }

  Point bent(const Point& p) const {
    const double d = (p - frame.start).dot(frame.down);
    const double at = d / step;
    const auto i = std::min(static_cast<std::size_t>(at), places.size() - 2);
    const double share = at - static_cast<double>(i);
    const Eigen::Vector3d across = p - frame.start - d * frame.down;
    return (1 - share) * places[i] + share * places[i + 1] + turn(d) * across;
  }
};

double greatest_depth(const std::vector<Point>& points, const RootFrame& frame) {
  double depth = 0;
  for (const Point& p : points) depth = std::max(depth, (p - frame.start).dot(frame.down));
  if (depth < 1) throw NoResultError("There is no root to steer below this crown.");
  return depth;
}

/// Stretches depths so that the greatest becomes `length`: not at all at the start, evenly beyond the first part.
void stretch(std::vector<Point>& points, const RootFrame& frame, double depth, double length) {
  const double ramp = std::min(3.0, depth / 3);
  const double rate = 1 + (length - depth) / (depth - ramp / 2);
  if (!(rate > 0.1))
    throw NoResultError(
        fmt::format("A root of {:.1f} mm cannot be made from the predicted one of {:.1f} mm.", length, depth));
  for (Point& p : points) {
    const double d = (p - frame.start).dot(frame.down);
    if (d <= 0) continue;
    // the integral of 1 + (rate - 1) min(d / ramp, 1)
    const double more = d < ramp ? d * d / (2 * ramp) : d - ramp / 2;
    p += (rate - 1) * more * frame.down;
  }
}

}  // namespace

void require_steering_in_range(const RootSteering& steering) {
  if (steering.length_mm && !(*steering.length_mm >= shortest_root_mm && *steering.length_mm <= longest_root_mm))
    throw UsageError(fmt::format("A root length of {} mm is out of its range, {} to {} mm.", *steering.length_mm,
                                 shortest_root_mm, longest_root_mm));
  require_angle(steering.tip_degrees, 30, "tip");
  require_angle(steering.torque_degrees, 30, "torque");
  require_angle(steering.bend_degrees, 45, "bend");
}

void steer_root(std::vector<Point>& points, const TriangleMesh& crown, const CanonicalFrame& frame, int fdi,
                const RootSteering& steering) {
  require_steering_in_range(steering);
  if (!steering.any()) return;
  const RootFrame root = root_frame(crown, frame, fdi);
  const CentreLine line(root, steering, greatest_depth(points, root));
  for (Point& p : points)
    if ((p - root.start).dot(root.down) > 0) p = line.bent(p);
  if (steering.length_mm) stretch(points, root, greatest_depth(points, root), *steering.length_mm);
}

}  // namespace rhizodont
