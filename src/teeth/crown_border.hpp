// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "mesh/closest_point.hpp"
#include "rhizodont/mesh.hpp"

#include <array>
#include <utility>
#include <vector>

namespace rhizodont {

/// The border of an open crown.
struct CrownBorder {
  std::vector<bool> is_vertex;                  ///< per crown vertex
  std::vector<std::array<bool, 3>> is_edge;     ///< per crown triangle: the edge from corner i to corner (i + 1) % 3
  std::vector<std::pair<int, int>> half_edges;  ///< the crown lies to the left of first -> second, seen from outside
  double sharpest_notch = 180;  ///< degrees: smallest angle between two border edges that is open to the
                                ///< root; a triangle in it has no larger one there
  double mean_edge = 0;         ///< mm
};

/// Throws InputError for a closed crown.
CrownBorder find_crown_border(const TriangleMesh& crown);

/// Whether the closest point of the crown, as found by `ClosestPointIndex`, lies on its border.
bool lies_on_border(const TriangleMesh& crown, const CrownBorder& border, const ClosestPoint& closest);

/// Where each vertex of the guiding surface lies beside the crown.
struct CrownDistances {
  std::vector<double> distance;         ///< mm, >= 0, from the crown
  std::vector<bool> closest_on_border;  ///< the crown's closest point lies on its border
};

/// Precondition: `border` is that of `crown`. Throws what `ClosestPointIndex` throws.
CrownDistances crown_distances(const TriangleMesh& guiding_surface, const TriangleMesh& crown,
                               const CrownBorder& border);

}  // namespace rhizodont
