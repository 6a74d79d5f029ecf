// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "teeth/frame.hpp"

#include "mesh/geometry.hpp"
#include "rhizodont/error.hpp"

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

}  // namespace rhizodont
