// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"
#include "teeth/prepared_crown.hpp"

#include <vector>

namespace rhizodont {

struct SeparationOptions {
  double epsilon = 1.0;    ///< mm, > 0: guiding-surface vertices farther than this from the crown belong to the root
  double clearance = 0.1;  ///< mm, >= 0: nearer ones are left to the crown although they lie beyond its border
};

/// Throws UsageError for an option out of its range.
void require_in_range(const SeparationOptions& options);

/// Separates the guiding surface into crown and root (paper, 3.6): true for the vertices that belong to the root. A
/// vertex is root if it is farther than epsilon from the crown, or nearer but beyond the crown's border by more than
/// the clearance: the closest point of the crown then lies on its border. Only the part connected to the root vertex
/// that is lowest along the growth axis is kept.
///
/// `distances` as `crown_distances` finds them, `growth_axis` a unit vector from root to crown. Throws NoResultError if
/// no root is left.
std::vector<bool> separate_crown_and_root(const TriangleMesh& guiding_surface, const CrownDistances& distances,
                                          const Eigen::Vector3d& growth_axis, const SeparationOptions& options = {});

}  // namespace rhizodont
