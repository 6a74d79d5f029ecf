// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "isosurface/cut_cells.hpp"

namespace rhizodont {

/// A mesh whose vertices lie on cut edges of the tiling.
struct EdgeMesh {
  std::vector<std::array<std::int32_t, 2>> edges;  ///< per mesh vertex: lattice vertices inside, outside
  std::vector<Triangle> triangles;                 ///< counterclockwise from outside
};

/// The triangles that separate the inside corners of the cells from the outside ones (MidNormal).
EdgeMesh triangulate_cells(const CutCells& cells);

/// Takes out vertices of valence 4; the hole gets the diagonal that evens out the valences. Leaves a vertex where its
/// removal would make an edge twice. Returns how many were removed. Precondition: closed and 2-manifold.
std::size_t remove_valence_4(EdgeMesh& mesh);

/// Vertices - edges + triangles.
/// \throws NoResultError (ids = vertices) if the triangles do not form one closed, consistently oriented 2-manifold
int checked_euler_number(std::size_t vertices, const std::vector<Triangle>& triangles);

}  // namespace rhizodont
