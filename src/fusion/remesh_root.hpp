// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fusion/edge_lengths.hpp"
#include "fusion/restore.hpp"
#include "fusion/surface_walk.hpp"

#include <vector>

namespace rhizodont {

struct RemeshRootOptions {
  int iterations = 10;      ///< >= 0: of relaxation
  double longest = 1.6;     ///< > 1: edges longer than this, relative to the length wanted there, are split
  double shortest = 0.5;    ///< (0, 1): shorter ones are collapsed
  double fading = 0.75;     ///< mm, > 0: over which the offset between the crown's border and the guiding surface fades
  double least_angle = 28;  ///< degrees, [0, 30]: triangles with a smaller one are mended
  int mending_rounds = 12;  ///< >= 0
  double inner_angle =
      21;  ///< degrees: mending starts anew from relaxed vertices if an angle is left smaller than this,
  double border_angle = 6;       ///< or than this in a triangle that touches the crown,
  int mending_passes = 3;        ///< at most so often, >= 0
  double mending_splits = 0.25;  ///< >= 0: edges that mending may split, per new triangle that there was before
  double mending_places = 40;    ///< >= 0: places for vertices that it may try, likewise
};

/// Throws UsageError for an option out of its range.
void require_in_range(const RemeshRootOptions& options);

/// What was done to the root's triangles.
struct RootRemeshing {
  int splits = 0;
  int collapses = 0;
  int flips = 0;
  int mended = 0;  ///< operations that took away small angles
};

/// Improves the new triangles of a tooth along the guiding surface: edges far from the wanted length are split or
/// collapsed, edges turned until they are Delaunay, free vertices relaxed, small angles mended. Crown vertices and
/// triangles stay the first of the mesh, as they were. Nothing within `frozen_radius` (mm) of `frozen_centres` is
/// changed. The result is not tested for self-intersection.
RootRemeshing remesh_root(JoinedTooth& tooth, const SurfaceWalk& guiding_surface, const EdgeLengths& lengths,
                          const std::vector<Point>& frozen_centres, double frozen_radius,
                          const RemeshRootOptions& options = {});

}  // namespace rhizodont
