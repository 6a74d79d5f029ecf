// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fusion/fitted_patch.hpp"

#include <cstdint>

namespace rhizodont {

/// How much mending may do yet. Where the crown forces small angles, every triangle put there has another, and no end
/// is in sight: needles, slits.
struct MendingBudget {
  std::int64_t splits = 0;  ///< edges split
  std::int64_t places = 0;  ///< places for a vertex tried
};

/// Takes away small angles by local operations: an edge is turned, collapsed or split, or a vertex moved, wherever that
/// makes the smallest angle of the triangles concerned larger. `least_angle` in radians: triangles that have a smaller
/// one are worked on. Angles of triangles that touch the crown count `crown_weight` times: with more than 1 they may be
/// made worse for the sake of others. What is done is taken off the budget; once it is used up, angles are left as they
/// are. Returns the number of operations.
int mend_angles(FittedPatch& patch, double least_angle, int rounds, MendingBudget& budget, double crown_weight = 1);

}  // namespace rhizodont
