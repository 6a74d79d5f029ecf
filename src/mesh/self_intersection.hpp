// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

#include <cstddef>
#include <utility>
#include <vector>

namespace rhizodont {

/// Pairs (lower, higher id) of triangles that meet elsewhere than in the vertices and edges they share by index;
/// sorted. Decided exactly on the given double coordinates. Triangles that only touch count as meeting; so do triangles
/// with the same three vertices and neighbours folded onto each other in one plane. Works on any soup. A triangle
/// without area counts as the segment it covers, and is not tested against triangles with which it shares a vertex.
/// @param first_clear  so many triangles, the first of the mesh, are known not to meet each other: pairs of them are
///                     not looked at, which spares most of the work where a few are new
/// Throws InputError for non-finite vertices or indices out of range.
std::vector<std::pair<int, int>> self_intersecting_triangles(const TriangleMesh& mesh, std::size_t first_clear = 0);

/// Which of `others`, triangles over the mesh's vertices, meet any triangle of the mesh, in the same sense. A segment
/// between two vertices is the triangle that has one of them twice. Throws InputError as above.
std::vector<bool> meeting_mesh(const TriangleMesh& mesh, const std::vector<Triangle>& others);

}  // namespace rhizodont
