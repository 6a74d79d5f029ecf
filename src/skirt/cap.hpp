// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

#include <vector>

namespace rhizodont {

struct CapOptions {
  double facing = 0.35;          ///< cosine, (-1, 1): triangles whose normal has more than this along the root's
                                 ///< direction look like cap, others like crown
  double ridge_angle = 15;       ///< degrees, > 0: ridges sharper than this are where a cap is likely to begin
  double least_flatness = 0.68;  ///< [0, 1]: |sum of area vectors| / area that a cap must have
  double least_rim = 30;         ///< degrees, >= 0: mean bend of the surface across the cap's rim
  double least_share = 0.45;     ///< [0, 1]: cap's cross-section over that of the whole, both along the axis
};

/// The cap that closes the base of an exported crown.
struct Cap {
  std::vector<bool> is_cap;  ///< per triangle
  bool made = false;         ///< known to the triangle by the way in which a program made it: see `find_made_cap`
  int triangles = 0;         ///< number of true entries
  double flatness = 0;       ///< |sum of area vectors| / area of the cap
  double share = 0;          ///< cap's cross-section over that of the whole along the axis
  double rim = 0;            ///< degrees: mean bend of the surface across the rim, from 1 mm on one side to the other
  double depth = 0;          ///< mm, along the axis: how far its middle lies inside of its rim
  double curvature = 0;      ///< 1/mm: mean bend inside the cap; caps are smoother than chewing surfaces
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();  ///< unit, the cap's mean normal: out of the crown
};

/// Finds the region of a closed crown that looks most like a cap over its base: it faces the root, and ends where the
/// surface bends (a minimum cut over the triangles). It may still be no cap: see `require_cap`.
/// `growth_axis`: unit vector from root to crown, known to about 20 degrees.
/// Throws InputError where no region faces the root.
Cap find_cap(const TriangleMesh& closed_crown, const Eigen::Vector3d& growth_axis, const CapOptions& options = {});

/// The figures of a region that is taken for a cap. Throws InputError where it is empty, all, or without a direction.
Cap describe_cap(const TriangleMesh& closed_crown, std::vector<bool> is_cap, const Eigen::Vector3d& growth_axis);

/// Area, mm^2, of the convex outline of the vertices seen along an axis (unit vector).
double outline_area(const TriangleMesh& mesh, const Eigen::Vector3d& axis);

/// Throws InputError, with what is missing, for regions that are no cap: of a ball, of a whole tooth.
void require_cap(const Cap& cap, const CapOptions& options = {});

}  // namespace rhizodont
