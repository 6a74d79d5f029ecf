// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fusion/join.hpp"
#include "rhizodont/mesh.hpp"

namespace rhizodont {

struct RestoreOptions {
  int rounds = 6;  ///< how often root triangles that cut others may be taken back and the gap filled anew, >= 0
};

/// Throws UsageError for an option out of its range.
void require_in_range(const RestoreOptions& options);

/// A closed tooth that contains the crown as it was: vertices [0, crown_vertices) and triangles [0, crown_triangles)
/// are the crown's own, in the crown's order; no Steiner point is left.
struct JoinedTooth {
  TriangleMesh mesh;
  int crown_vertices = 0;
  int crown_triangles = 0;
  int triangles_brought_back = 0;  ///< crown triangles that the dual lacked
  int triangles_filled = 0;        ///< new triangles that the dual lacked
  int holes_filled = 0;            ///< gaps between crown and root, and holes of the crown itself
};

/// Puts the crown's original triangles in the place of what the dual made of them. The dual's triangles with a root
/// vertex are kept as far as they fit the crown's border; gaps that remain are filled over their border vertices.
/// Where the result cuts itself, root triangles are taken back around the place and the gap is filled again.
///
/// `crown`: the one given to `join_crown_and_root`, manifold, its border loops not touching, one component, its
/// triangles not cutting each other, which is not tested again.
/// Throws NoResultError if the dual has no root or one that is closed by itself; with ids of the triangles, if no
/// closed manifold without self-intersection is found.
JoinedTooth restore_crown(const TriangleMesh& crown, const Joining& joining, const RestoreOptions& options = {});

}  // namespace rhizodont
