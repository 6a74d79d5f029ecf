// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

namespace rhizodont {

/// Throws InputError with the ids of the triangles that have an index out of range.
void require_valid_indices(const TriangleMesh& mesh);

/// Throws InputError with the ids of the points that have a coordinate that is NaN or infinite.
void require_finite(const std::vector<Point>& points);

}  // namespace rhizodont
