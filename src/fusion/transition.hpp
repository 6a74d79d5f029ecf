// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fusion/restore.hpp"

#include <optional>
#include <vector>

namespace rhizodont {

struct TransitionOptions {
  /// mm, >= 0: new vertices within this distance of the crown, along edges, are smoothed. Unset: wide enough to take up
  /// the gap at the slope below, and at least so many rows of triangles, within the bounds below.
  std::optional<double> width;
  double gap = 0;            ///< mm, >= 0: how far the root's surface misses the crown's border
  double slope = 0.15;       ///< > 0: rise per length at which a gap is taken up
  double rows = 3;           ///< > 0: least width in border edges
  double least_width = 0.8;  ///< mm, >= 0
  double largest_width = 4;  ///< mm, >= least_width
  double inner_angle = 20;   ///< degrees, [0, 30]: smoothing takes no angle of a new triangle below this,
  double border_angle = 5;   ///< nor below this where the triangle touches the crown
  int cut_rounds = 6;        ///< >= 1: tests for self-intersection, each but the last followed by taking moves back
};

/// Throws UsageError for an option out of its range.
void require_in_range(const TransitionOptions& options);

struct Transition {
  std::vector<int> vertices;  ///< the vertices that form the transition, ascending
  double width = 0;           ///< mm
  double applied = 1;         ///< share of the biharmonic displacement that was safe to apply, mean over vertices, 0..1
  double largest_move = 0;    ///< mm
  bool cuts_itself = false;   ///< the tooth cuts itself, with or without smoothing
};

/// Heals the seam between crown and root: the vertices of the band are moved to the solution of the biharmonic equation
/// L M^-1 L x = 0 with all other vertices fixed, so that the surface continues the crown's slope (paper, 3.6). Crown
/// vertices never move. Where a triangle would turn over, lose a good angle or cut another, the vertices about it move
/// less or not at all. Precondition: the crown's own triangles do not cut each other.
Transition smooth_transition(JoinedTooth& tooth, const TransitionOptions& options = {});

}  // namespace rhizodont
