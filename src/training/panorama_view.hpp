// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "base/random_stream.hpp"
#include "rhizodont/mesh.hpp"

namespace rhizodont {

/// From where a crown is looked at.
struct PanoramaView {
  Eigen::Vector3d axis;  ///< unit
  Point centre;          ///< mm
};

/// A little beside where a crown should be looked at from along an axis (unit): borders are ragged, axis and middle
/// found from them differ from scan to scan. Throws InputError for crowns without area or border.
PanoramaView view_from_beside(const TriangleMesh& crown, const Eigen::Vector3d& axis, RandomStream& random);

}  // namespace rhizodont
