// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "segment/teeth_reading.hpp"

#include <Eigen/Geometry>

namespace rhizodont {
namespace {

Eigen::Vector3d vector_of(const std::array<float, 3>& v) { return Eigen::Vector3f(v[0], v[1], v[2]).cast<double>(); }

/// Turns what is read so that it stands as the network says.
Eigen::Matrix3d upright(const ScanReading& said) {
  Eigen::Vector3d z = vector_of(said.occlusal);
  if (!(z.norm() > 1e-3)) z = Eigen::Vector3d::UnitZ();
  return rotation_to(z.normalized(), vector_of(said.front));
}

/// The rotation in steps of some degrees: what hangs on which points were chosen does not then choose other points.
Eigen::Matrix3d in_steps(const Eigen::Matrix3d& rotation) {
  constexpr double step = 0.06;  // rad; the network was trained with more
  const Eigen::AngleAxisd turn(rotation);
  const Eigen::Vector3d steps = (turn.angle() / step * turn.axis()).array().round();
  if (steps.isZero()) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(step * steps.norm(), steps.normalized()).toRotationMatrix();
}

}  // namespace

Eigen::Vector3d TeethReading::place(std::size_t point) const { return vector_at(pyramid.levels[0].positions, point); }

Eigen::Vector3d TeethReading::normal(std::size_t point) const { return vector_at(pyramid.levels[0].normals, point); }

double TeethReading::probability(std::size_t point, int kind) const {
  return static_cast<double>(said.kinds[scan_kind_count * point + static_cast<std::size_t>(kind)]);
}

Eigen::Vector3d TeethReading::vote(std::size_t point) const { return place(point) + vector_at(said.offsets, point); }

TeethReading read_teeth(const TriangleMesh& scan, const ScanNetwork& network, int turns) {
  TeethReading reading;
  reading.frame = first_frame(scan);
  ScanCloud& cloud = reading.cloud;
  cloud = scan_points(scan, reading.frame).cloud;
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  for (int pass = 0; pass <= turns; ++pass) {
    reading.frame.origin += reading.frame.rotation.transpose() * mean_place(cloud);
    reading.frame.rotation = turn * reading.frame.rotation;
    cloud = turned(cloud, turn);
    reading.pyramid = scan_pyramid(cloud, network.shape());
    reading.said = network.read(reading.pyramid);
    turn = in_steps(upright(reading.said));
    if (turn.isIdentity()) break;
  }
  return reading;
}

}  // namespace rhizodont
