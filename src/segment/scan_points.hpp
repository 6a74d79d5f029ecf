// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "networks/scan_sample.hpp"
#include "rhizodont/mesh.hpp"

#include <Eigen/Core>

#include <vector>

namespace rhizodont {

/// Number i of vectors that lie behind each other.
inline Eigen::Vector3d vector_at(const std::vector<float>& xyz, std::size_t i) {
  return Eigen::Vector3f(xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]).cast<double>();
}

/// A scan's frame: place in it = rotation * (place in the scan - origin).
struct ScanFrame {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();  ///< proper
  Point origin = Point::Zero();
};

/// Points that cover a scan evenly, whatever its triangles are.
struct ScanPoints {
  ScanCloud cloud;
  std::vector<int> vertices;  ///< per point: a vertex of the scan beside it
};

/// One point for each half millimetre of surface or so, in a frame. Curvatures are by means over the points within 1 mm
/// and 2.2 mm: positive in hollows. Triangles without area count for nothing. Throws InputError where none has one.
ScanPoints scan_points(const TriangleMesh& scan, const ScanFrame& frame);

/// The proper rotation whose rows are the frame's axes: z is `up`, y the part of `front` at right angles to it; where
/// that vanishes, any. `up` unit.
Eigen::Matrix3d rotation_to(const Eigen::Vector3d& up, const Eigen::Vector3d& front);

/// Puts the frame's origin where the mean of its points is. The cloud has points.
void move_origin_to_mean(ScanFrame& frame, ScanCloud& cloud);

/// A frame that turns and moves with the scan: z is the way that its surface faces on the whole, or, of a closed model,
/// away from its flat base; y towards the part farthest from the middle. Origin: the surface's centroid. Throws
/// InputError for a scan without area.
ScanFrame first_frame(const TriangleMesh& scan);

}  // namespace rhizodont
