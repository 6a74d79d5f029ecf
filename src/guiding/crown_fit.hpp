// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"
#include "teeth/prepared_crown.hpp"

namespace rhizodont {

struct CrownFitOptions {
  double tolerance = 0.0075;  ///< mm, > 0: triangles are split until no crown vertex within reach is farther away
  double reach = 0.3;         ///< mm, > 0: farthest that a vertex is moved onto the crown
  int fading_rings = 3;       ///< >= 0: rings of vertices beyond the crown over which the moves fade out
  int most_rounds = 8;        ///< >= 0: of splitting
};

/// What the fit did, and how near the surface came.
struct CrownFit {
  int moved_vertices = 0;  ///< onto the crown, or with their neighbours beyond its border
  int added_vertices = 0;  ///< by splitting edges
  bool undone = false;     ///< the moved surface would have met itself: left as it came
};

/// Draws the guiding surface onto the scanned crown, which it can only approach as an isosurface of smooth functions in
/// cells of size e (paper, 3.5 and table 1: the guiding surface has to be close to the crown). Vertices near the crown
/// move to their closest points on it; moves fade out beyond its border. Where a triangle still cuts across a fissure
/// or a cusp, its longest edge is split (Rivara 1984) and the new vertex set on the crown. Triangles away from the
/// crown stay as they are. The surface stays closed, of the same topology, and free of self-intersections.
///
/// Precondition: `surface` closed, oriented and manifold.
CrownFit fit_to_crown(TriangleMesh& surface, const PreparedCrown& crown, const CrownFitOptions& options = {});

}  // namespace rhizodont
