// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

#include <limits>
#include <vector>

namespace rhizodont {

/// Per vertex the length in mm of the shortest way along edges from the nearest of the `sources` (indices in range);
/// infinity beyond `limit` (mm, >= 0) and where no way leads. Works on any mesh with valid indices, manifold or not.
/// E. Dijkstra, "A note on two problems in connexion with graphs", 1959.
std::vector<double> distances_along_edges(const TriangleMesh& mesh, const std::vector<int>& sources,
                                          double limit = std::numeric_limits<double>::infinity());

}  // namespace rhizodont
