// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

#include <vector>

namespace rhizodont {

/// The part of a raw crown that can be judged by its surface: per triangle whether it belongs to it. Left out are
/// triangles at edges with more than two of them, triangles turned against those beside them, copies of others, and all
/// but the piece with the largest area. Everything of a sound mesh of one piece.
/// Precondition: indices in range, three different ones per triangle, finite coordinates.
std::vector<bool> sound_triangles(const TriangleMesh& crown);

struct RaggedPartOptions {
  double depth = 1.0;  ///< mm, >= 0: how far from the base's border, along edges, a defect belongs to the ragged part
  int rounds = 30;     ///< >= 1: one defect taken off may lay bare the next
  double slit = 0.15;  ///< mean edge lengths, [0, 1]: borders nearer to each other than this are the sides of a slit
};

/// Per triangle of an opened crown whether it stays once the defects of its ragged part are taken off: edges with more
/// than two triangles, triangles turned against those beside them, vertices where the surface only touches itself,
/// handles (bridges over gaps, tubes), places where it cuts itself. Of each the vertex goes that is nearest to the
/// border; a handle is opened where it is nearest to it. A defect farther than `depth` from the border is one of the
/// tooth's own surface and stays.
/// Vertices near the border are dropped for it even if they belong to the tooth: what stays has to be a surface.
std::vector<bool> triangles_without_ragged_defects(const TriangleMesh& open_crown,
                                                   const RaggedPartOptions& options = {});

/// Per triangle of an opened crown whether it stays once the slits of its ragged part are opened: vertices of the
/// border within `depth` that nearly meet another part of it go. No triangle that fills a slit has a good angle.
/// Precondition: border loops do not touch.
std::vector<bool> triangles_without_slits(const TriangleMesh& open_crown, const RaggedPartOptions& options = {});

}  // namespace rhizodont
