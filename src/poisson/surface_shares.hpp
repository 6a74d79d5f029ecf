// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "rhizodont/mesh.hpp"

namespace rhizodont {

/// Each sample's share of the surface in mm^2, from how far away its neighbours are. Neighbours whose normals point the
/// other way lie on another sheet and do not count. Samples that all but coincide share what one would have.
/// Preconditions: finite points, unit normals, at least `neighbours` + 2 samples, neighbours >= 3.
std::vector<double> surface_shares(const OrientedPoints& samples, int neighbours);

}  // namespace rhizodont
