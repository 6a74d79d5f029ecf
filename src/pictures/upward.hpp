// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/io.hpp"

namespace rhizodont {

/// Unit direction that stands upwards in a picture, from root to crown: the area vector of an open crown, or of the
/// scanned part of a completed tooth (vertex attribute `source`); of a closed mesh, which has none, the z axis.
Eigen::Vector3d upward_of(const MeshFile& file);

}  // namespace rhizodont
