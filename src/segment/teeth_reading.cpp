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
  reading.cloud = scan_points(scan, reading.frame).cloud;
  move_origin_to_mean(reading.frame, reading.cloud);
  // The points are chosen once: another choice for a slightly other turn would give slightly other borders.
  reading.pyramid = scan_pyramid(reading.cloud, network.shape());
  reading.said = network.read(reading.pyramid);
  for (int pass = 0; pass < turns; ++pass) {
    const Eigen::Matrix3d up = upright(reading.said);
    reading.frame.rotation = up * reading.frame.rotation;
    turn(up, reading.cloud);
    turn(up, reading.pyramid);
    reading.said = network.read(reading.pyramid);
  }
  return reading;
}

}  // namespace rhizodont
