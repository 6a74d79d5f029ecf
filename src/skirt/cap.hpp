// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

#include <vector>

namespace rhizodont {

struct CapOptions {
  double facing = 0.35;          ///< cosine, (-1, 1): triangles whose normal has more than this along the root's
                                 ///< direction look like cap, others like crown
  double ridge_angle = 15;       ///< degrees, > 0: ridges sharper than this are where a cap is likely to begin
  double least_flatness = 0.78;  ///< [0, 1]: |sum of area vectors| / area that a cap must have
  double least_share = 0.45;     ///< [0, 1]: cap's cross-section over that of the whole, both along the axis
};

/// The cap that closes the base of an exported crown.
struct Cap {
  std::vector<bool> is_cap;  ///< per triangle
  int triangles = 0;         ///< number of true entries
  double flatness = 0;       ///< |sum of area vectors| / area of the cap
  double share = 0;          ///< cap's cross-section over that of the whole along the axis
};

/// Recognises the cap over the base of a closed crown: the region that faces the root, flat, and bounded where the
/// surface bends, found by a minimum cut over the triangles.
/// `growth_axis`: unit vector from root to crown, known to about 20 degrees.
/// Throws InputError where nothing looks like a cap: a ball, a whole tooth.
Cap recognise_cap(const TriangleMesh& closed_crown, const Eigen::Vector3d& growth_axis, const CapOptions& options = {});

}  // namespace rhizodont
