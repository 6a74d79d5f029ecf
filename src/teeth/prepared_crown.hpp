// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "mesh/closest_point.hpp"
#include "rhizodont/mesh.hpp"
#include "teeth/crown_border.hpp"

#include <vector>

namespace rhizodont {

/// A usable crown with what all stages ask of it, found once.
struct PreparedCrown {
  TriangleMesh mesh;            ///< open at its base, millimetres
  Eigen::Vector3d growth_axis;  ///< unit, from root to crown
  CrownBorder border;
  ClosestPointIndex surface;  ///< of `mesh`
};

/// Throws InputError for a crown that is closed, or without area or axis.
PreparedCrown prepare_crown(TriangleMesh open_crown);

/// Whether a closest point of the crown, as `crown.surface` gives it, lies on its border.
bool lies_on_border(const PreparedCrown& crown, const ClosestPoint& closest);

/// Where each vertex of the guiding surface lies beside the crown.
struct CrownDistances {
  std::vector<double> distance;         ///< mm, >= 0, from the crown
  std::vector<bool> closest_on_border;  ///< the crown's closest point lies on its border
};

CrownDistances crown_distances(const TriangleMesh& guiding_surface, const PreparedCrown& crown);

}  // namespace rhizodont
