// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "mesh/adjacency.hpp"
#include "rhizodont/mesh.hpp"

#include <vector>

namespace rhizodont {

/// Handles of a surface, open or closed, all pieces together: bridges over gaps and tunnels (its genus). By Euler and
/// Poincare, V - E + F = 2 (C - h) - B with C pieces and B border loops. A vertex where fans of triangles only touch
/// counts once for each fan, so that it joins nothing. Precondition: every edge has one or two triangles, not turned
/// against each other; else the number means nothing.
int handle_count(const TriangleMesh& mesh);

/// The same of the triangles with a true entry in `mask` (one per triangle); `edges` are those of the whole mesh. Takes
/// time in proportion to the mesh, for those who ask often.
int handle_count(const TriangleMesh& mesh, const EdgeTable& edges, const std::vector<bool>& mask);

}  // namespace rhizodont
