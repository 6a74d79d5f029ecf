// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

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

}  // namespace rhizodont
