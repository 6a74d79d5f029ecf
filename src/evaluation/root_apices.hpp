// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

#include <cstddef>
#include <vector>

namespace rhizodont {

/// The tip of a root.
struct RootApex {
  Point point = Point::Zero();  ///< mm
  /// mm, > 0: how far one has to climb along the axis from here until a deeper root is met (the furcation), or up to
  /// the level below which roots were looked for.
  double prominence_mm = 0;
};

/// The local minima along `axis` (unit, root to crown) that lie below `level` (mm along the axis) and are at least
/// `least_prominence_mm` (> 0) prominent, the deepest first. Empty if nothing reaches below the level.
/// Throws InputError for an index out of range or a coordinate that is not a number.
std::vector<RootApex> root_apices(const TriangleMesh& tooth, const Eigen::Vector3d& axis, double level,
                                  double least_prominence_mm);

/// A true apex and the predicted one that stands for it.
struct ApexPair {
  std::size_t truth = 0, predicted = 0;  ///< indices into the two lists
  double distance_mm = 0;
};

/// Pairs each apex of the shorter list with one of the longer, so that the sum of the distances is least; by index of
/// the truth. Of more than ten apices on a side, the ten most prominent take part.
std::vector<ApexPair> match_apices(const std::vector<RootApex>& truth, const std::vector<RootApex>& predicted);

}  // namespace rhizodont
