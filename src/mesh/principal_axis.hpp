// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

#include <vector>

namespace rhizodont {

/// Unit direction in which points spread most (first principal component), either way round: of a whole tooth's
/// vertices its long axis. There must be a point.
Eigen::Vector3d principal_axis(const std::vector<Point>& points);

}  // namespace rhizodont
