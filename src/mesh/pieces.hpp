// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "mesh/repair.hpp"
#include "rhizodont/mesh.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace rhizodont {

struct PieceOptions {
  double speck_area = 0.01;       ///< [0, 1): a piece of less than this share of the largest one's area and
  double speck_triangles = 0.02;  ///< [0, 1): at most this share of its triangles is a speck; a single triangle always
                                  ///< is beside a piece of 50 or more; what lies along a seam never is
  double all_specks = 0.05;       ///< [0, 1): with more triangles than this share of the mesh's in specks all together
                                  ///< it is no crown with specks but a crown in shreds: none is a speck then
  double like_share = 0.2;        ///< (0, 1]: a piece of at least this share of the largest one's area is of like size
};

/// What a piece is beside the largest one.
enum class PieceKind { largest, like, small, speck };

/// Pieces (joined over edges) of a mesh by their area.
struct Pieces {
  std::vector<int> of_triangle;  ///< piece of each triangle
  std::vector<PieceKind> kinds;  ///< per piece; of equal ones the first is the largest

  std::size_t count(PieceKind kind) const;
  PieceKind kind_of(std::size_t triangle) const { return kinds[static_cast<std::size_t>(of_triangle[triangle])]; }
};

/// Precondition: valid indices, finite coordinates.
Pieces sort_pieces(const TriangleMesh& mesh, const PieceOptions& options = {});

/// A sentence on a mesh of more than one piece: several crowns, a crown in halves (their borders run side by side), or
/// a crown with small pieces beside it. Empty for one piece.
std::string describe_pieces(const TriangleMesh& mesh, const Pieces& pieces);

/// The mesh without its specks, listed as one step; nothing else is touched. Meshes with indices out of range or
/// coordinates that are not finite come back as they are.
RepairedMesh drop_specks(const TriangleMesh& mesh, const PieceOptions& options = {});

}  // namespace rhizodont
