// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "completion/complete_points.hpp"

namespace rhizodont {

/// How far predicted points are the surface of one body and not a cloud of shreds.
struct Solidity {
  double in_one_piece = 0;  ///< share of the points that hang together over gaps of at most 0.8 mm, 0..1
  double scatter = 0;       ///< mean distance of the points from the planes through their neighbours, mm
  double below = 0;         ///< share of the points that lie below the crown, 0..1
};

/// Looks at the points below the crown: those lower along `growth_axis` (unit, root to crown) than `level` (mm along
/// the axis). Precondition: at least 32 predicted points.
Solidity solidity(const PredictedTooth& predicted, const Eigen::Vector3d& growth_axis, double level);

/// How far a root grows again on its way to the apex: the largest ratio of a cross-section, all its roots together, to
/// the smallest one that lies nearer to the crown. 1 for a root that only tapers, as the 16 template teeth do within
/// half a percent. Crumbs and drops hanging on threads have 1.5 and more; infinite where there is no root. `level`: of
/// the crown's lowest place, mm along `growth_axis`. Precondition: `tooth` closed and oriented.
double swelling(const TriangleMesh& tooth, const Eigen::Vector3d& growth_axis, double level);

/// How bad it is: 1 is the bound beyond which no root is made of the points; infinite where there are hardly any below
/// the crown.
double shreds(const Solidity& solidity);
/// Whether a root can be made of the points.
inline bool is_solid(const Solidity& solidity) { return shreds(solidity) <= 1; }

}  // namespace rhizodont
