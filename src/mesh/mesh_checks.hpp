// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

#include <span>
#include <vector>

namespace rhizodont {

/// Whether every index is a vertex, as most preconditions ask.
bool has_valid_indices(const TriangleMesh& mesh);

/// Whether every coordinate is a finite number.
bool is_finite(std::span<const Point> points);

/// Throws InputError with the ids of the triangles that have an index out of range.
void require_valid_indices(const TriangleMesh& mesh);

/// Throws InputError with the ids of the points that have a coordinate that is NaN or infinite.
void require_finite(const std::vector<Point>& points);

}  // namespace rhizodont
