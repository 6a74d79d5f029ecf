// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

namespace rhizodont {

/// A similarity between the scan's millimetres and the pose in which the completion network works:
/// canonical = M * rotation * (world - centre) / scale, with M = diag(-1, 1, 1) for teeth of the right side.
/// Canonical +z is the growth axis from root to crown; x and y are those of the type's mean crown (+y towards the
/// cheek).
struct CanonicalFrame {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();  ///< proper rotation, world to canonical directions
  Point centre = Point::Zero();                            ///< millimetres; area-weighted centroid of the crown surface
  bool mirrored = false;                                   ///< true for right-side teeth (quadrants 1 and 4)
  double scale = 12.0;                                     ///< millimetres per canonical unit, > 0

  /// World millimetres to canonical coordinates.
  Point to_canonical(const Point& world) const;
  /// Canonical coordinates to world millimetres; inverse of to_canonical to rounding.
  Point to_world(const Point& canonical) const;
  /// A direction (unit normal, axis) to the canonical pose; keeps its length.
  Eigen::Vector3d direction_to_canonical(const Eigen::Vector3d& world) const;
  /// A direction back to the world; keeps its length.
  Eigen::Vector3d direction_to_world(const Eigen::Vector3d& canonical) const;
};

/// Unit growth axis of an open crown, from root to crown: the normalised sum of its area vectors, which depends on its
/// border alone. Throws InputError if the sum vanishes (closed surface, or nothing to go by).
Eigen::Vector3d growth_axis(const TriangleMesh& open_crown);

/// Unit growth axis of a crown in its arch: a third of the way from the one that the arch expects to the border's own,
/// but at most 7 degrees away from the arch's. Gum that stands higher on one side leans a border by up to 40 degrees;
/// teeth of different people lean by 8 against the mean arch (models/arch.md). Both unit.
Eigen::Vector3d axis_in_arch(const Eigen::Vector3d& of_border, const Eigen::Vector3d& in_arch);

}  // namespace rhizodont
