// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fusion/restore.hpp"

#include <vector>

namespace rhizodont {

struct TransitionOptions {
  double band = 1.5;  ///< mm, >= 0: root vertices within this distance of the crown, along edges, are smoothed
};

struct Transition {
  std::vector<int> vertices;  ///< the vertices that form the transition, ascending
  double applied = 0;         ///< share of the biharmonic displacement that was safe to apply, 0..1
  double largest_move = 0;    ///< mm
};

/// Heals the seam between crown and root: the vertices of the band are moved to the solution of the biharmonic equation
/// L M^-1 L x = 0 with all other vertices fixed, so that the surface continues the crown's slope (paper, 3.6). Crown
/// vertices never move. The displacement is halved until no triangle turns over and the tooth does not cut itself, and
/// left out if that does not help.
Transition smooth_transition(RestoredTooth& tooth, const TransitionOptions& options = {});

}  // namespace rhizodont
