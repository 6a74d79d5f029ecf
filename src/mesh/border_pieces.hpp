// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

#include <utility>
#include <vector>

namespace rhizodont {

/// A connected part of a mesh's border: one loop, or several that touch in a vertex.
struct BorderPiece {
  std::vector<int> vertices;                    ///< ascending
  std::vector<std::pair<int, int>> half_edges;  ///< as the triangles beside them run, ascending
  /// mm^2: its part in the mesh's area vector. Of a flat loop, length and direction of what it encloses; the opening of
  /// a crown towards its root has one that points to the chewing surface, a slit has nearly none.
  Eigen::Vector3d area_vector = Eigen::Vector3d::Zero();
};

/// The pieces of the mesh's border (edges with one triangle), sorted by lowest vertex; none of a closed mesh.
/// Precondition: as for `edge_table`.
std::vector<BorderPiece> border_pieces(const TriangleMesh& mesh);

/// Which piece of a crown's border is its base, where the root begins: the one that encloses the largest cross-section.
/// How long a border is says nothing: a slit or a ragged hole may have a longer one. All others are holes of the scan.
/// The first of equals. Precondition: there is a piece.
std::size_t base_piece(const std::vector<BorderPiece>& pieces);

}  // namespace rhizodont
