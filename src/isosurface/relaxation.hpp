// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "isosurface/projection.hpp"

namespace rhizodont {

/// Slides vertices of triangles outside the range of angles that GradNormal promises along the surface, each only where
/// that improves the worst triangle around it. Such triangles arise where the surface bends within e. Returns how many
/// moved.
std::size_t relax_poor_triangles(const ScalarField& field, double iso, const IsosurfaceOptions& options,
                                 std::vector<EdgeVertex>& vertices, const std::vector<Triangle>& triangles);

}  // namespace rhizodont
