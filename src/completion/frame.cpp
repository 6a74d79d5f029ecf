// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "completion/frame.hpp"

#include "mesh/geometry.hpp"
#include "rhizodont/error.hpp"

#include <algorithm>
#include <cmath>
#include <string>

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

Eigen::Vector3d CrownFrame::form_direction() const {
  return {form_axis.x(), form_axis.y(), std::sqrt(std::max(0.0, 1 - form_axis.squaredNorm()))};
}

int tooth_type_of_fdi(int fdi) {
  const int quadrant = fdi / 10, position = fdi % 10;
  if (fdi < 0 || quadrant < 1 || quadrant > 4 || position < 1 || position > 8)
    throw UsageError(std::to_string(fdi) + " is not a permanent tooth: FDI numbers are 11-18, 21-28, 31-38, 41-48.");
  return (quadrant > 2 ? 8 : 0) + position - 1;
}

bool is_right_side(int fdi) {
  tooth_type_of_fdi(fdi);
  return fdi / 10 == 1 || fdi / 10 == 4;
}

int fdi_of_type(int type, bool right_side) {
  if (type < 0 || type >= tooth_type_count) throw UsageError("Tooth types go from 0 to 15.");
  const int quadrant = type < 8 ? (right_side ? 1 : 2) : (right_side ? 4 : 3);
  return 10 * quadrant + type % 8 + 1;
}

Eigen::Vector3d growth_axis(const TriangleMesh& open_crown) {
  const Eigen::Vector3d sum = area_vector(open_crown);
  // A closed surface sums to zero up to rounding; an open crown to about the area of its neck.
  if (!(sum.norm() > 1e-3 * surface_area(open_crown)) || !sum.allFinite())
    throw InputError("The crown has no open border below, so its growth axis cannot be told.");
  return sum.normalized();
}

}  // namespace rhizodont
