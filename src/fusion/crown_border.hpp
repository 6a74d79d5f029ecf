// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "mesh/closest_point.hpp"
#include "rhizodont/mesh.hpp"

#include <set>
#include <utility>
#include <vector>

namespace rhizodont {

/// The border of an open crown.
struct CrownBorder {
  std::vector<bool> is_vertex;          ///< per crown vertex
  std::set<std::pair<int, int>> edges;  ///< lower, higher vertex
  double mean_edge = 0;                 ///< mm
};

/// Throws InputError for a closed crown.
CrownBorder find_crown_border(const TriangleMesh& crown);

/// Whether the closest point of the crown, as found by `ClosestPointIndex`, lies on its border.
bool lies_on_border(const TriangleMesh& crown, const CrownBorder& border, const ClosestPoint& closest);

}  // namespace rhizodont
