// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

#include <vector>

namespace rhizodont {

/// Areas of a closed surface's cross-sections by planes across `axis` (unit), `step` mm (> 0) apart: the first at
/// `from`, a height along the axis, the others below it, down to the surface's lowest place. Several pieces of one
/// section count together. Empty if the surface lies above `from`. Precondition: closed and oriented, in mm.
std::vector<double> cross_section_areas(const TriangleMesh& closed_surface, const Eigen::Vector3d& axis, double from,
                                        double step);

}  // namespace rhizodont
