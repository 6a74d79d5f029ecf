// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

#include <vector>

namespace rhizodont {

/// A mesh whose holes were closed: the same vertices and triangles in the same order, then the new triangles.
struct FilledMesh {
  TriangleMesh mesh;
  int holes = 0;  ///< number of border loops that were filled
};

/// Closes every hole with triangles over its border vertices, choosing those that bend least (CGAL: P. Liepa, "Filling
/// holes in meshes", 2003). No vertex is added or moved. Precondition: manifold, border loops do not touch.
/// Throws NoResultError (ids of the border vertices) where a hole cannot be filled without repeating an edge.
FilledMesh fill_holes(const TriangleMesh& mesh);

/// The same; where those triangles meet the mesh or each other, holes are filled anew with others that do not
/// (clear_filling). Where none are found they stay as they are.
FilledMesh fill_holes_clear(const TriangleMesh& mesh);

}  // namespace rhizodont
