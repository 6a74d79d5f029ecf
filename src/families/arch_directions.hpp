// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace rhizodont {

/// Unit direction from the tongue to the cheek at tooth `i` of one side of an arch: across the line to its neighbours,
/// level. @param arch  >= 2 middles of the left side's crowns from the front to the back (y up, z to the front, x left)
Eigen::Vector3d buccal_direction(const std::vector<Eigen::Vector3d>& arch, std::size_t i);

}  // namespace rhizodont
