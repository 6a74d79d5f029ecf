// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/dropped_vertex.hpp"
#include "rhizodont/mesh.hpp"

#include <vector>

namespace rhizodont {

/// What is left of a crown, with where each element stood before. Order is kept.
struct KeptCrown {
  TriangleMesh mesh;
  std::vector<int> old_vertices;            ///< index in the input per kept vertex, ascending
  std::vector<int> old_triangles;           ///< likewise for triangles
  std::vector<DroppedCrownVertex> dropped;  ///< ascending by vertex
};

/// Reduces a crown to the vertices of the triangles with a true entry in `keep`, with every triangle between them; then
/// as far as needed for its border to be made of separate simple loops: vertices that the border passes twice, and what
/// hangs on the rest by them only, go. `reason` is noted for the vertices outside of `keep`.
/// `never`: triangles that are not kept even where all their vertices are; one entry per triangle, or empty for none.
/// Throws InputError if nothing is left.
KeptCrown keep_crown(const TriangleMesh& crown, const std::vector<bool>& keep, DropReason reason,
                     const std::vector<bool>& never = {});

}  // namespace rhizodont
