// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

#include <vector>

namespace rhizodont {

struct SeparationOptions {
  double epsilon = 1.0;    ///< mm, > 0: guiding-surface vertices farther than this from the crown belong to the root
  double clearance = 0.6;  ///< relative to the border's mean edge length, >= 0: nearer ones are left out, so that no
                           ///< root vertex crowds the crown's border
};

/// Which vertices of the guiding surface are root vertices (V2 of the paper).
struct Separation {
  std::vector<bool> is_root;  ///< per vertex of the guiding surface
  int root_vertices = 0;      ///< number of true entries
  int islands_dropped = 0;    ///< root-labelled vertices not connected to the root proper, counted as crown
};

/// Separates the guiding surface into crown and root (paper, 3.6). A vertex is root if it is farther than epsilon from
/// the crown, or nearer but beyond the crown's border by more than the clearance: the closest point of the crown then
/// lies on its border. Only the part connected to the root vertex that is lowest along the growth axis is kept.
///
/// `crown` is open with `growth_axis` a unit vector from root to crown. Throws InputError for a closed crown and
/// NoResultError if no root is left.
Separation separate_crown_and_root(const TriangleMesh& guiding_surface, const TriangleMesh& crown,
                                   const Eigen::Vector3d& growth_axis, const SeparationOptions& options = {});

}  // namespace rhizodont
