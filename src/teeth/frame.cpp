// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "teeth/frame.hpp"

#include "mesh/geometry.hpp"
#include "rhizodont/error.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace rhizodont {

Point CanonicalFrame::to_canonical(const Point& world) const { return direction_to_canonical(world - centre) / scale; }

Point CanonicalFrame::to_world(const Point& canonical) const { return direction_to_world(canonical) * scale + centre; }

Eigen::Vector3d CanonicalFrame::direction_to_canonical(const Eigen::Vector3d& world) const {
  Eigen::Vector3d turned = rotation * world;
  if (mirrored) turned.x() = -turned.x();
  return turned;
}

Eigen::Vector3d CanonicalFrame::direction_to_world(const Eigen::Vector3d& canonical) const {
  Eigen::Vector3d turned = canonical;
  if (mirrored) turned.x() = -turned.x();
  return rotation.transpose() * turned;
}

Eigen::Vector3d growth_axis(const TriangleMesh& open_crown) {
  const Eigen::Vector3d sum = area_vector(open_crown);
  // A closed surface sums to zero up to rounding; an open crown to about the area of its neck.
  if (!(sum.norm() > 1e-3 * surface_area(open_crown)) || !sum.allFinite())
    throw InputError("The crown has no open border below, so its growth axis cannot be told.");
  return sum.normalized();
}

Eigen::Vector3d axis_in_arch(const Eigen::Vector3d& of_border, const Eigen::Vector3d& in_arch) {
  constexpr double share = 1.0 / 3, most = 7 * std::numbers::pi / 180;
  const Eigen::Vector3d about = in_arch.cross(of_border);
  const double sine = about.norm();
  if (!(sine > 0)) return in_arch;
  const double angle = std::atan2(sine, in_arch.dot(of_border));
  return Eigen::AngleAxisd(std::min(share * angle, most), about / sine) * in_arch;
}

}  // namespace rhizodont
