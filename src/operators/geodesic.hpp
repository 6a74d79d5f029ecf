// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

#include <vector>

namespace rhizodont {

/// Length in mm of the shortest way over the surface from each vertex to the nearest of `sources`; fast marching over
/// triangles (R. Kimmel, J. Sethian, "Computing geodesic paths on manifolds", 1998), along edges where a triangle is
/// obtuse: a few per cent too long. Infinite where no way leads to, or where there are no sources.
/// Throws InputError for an index out of range.
std::vector<double> geodesic_distances(const TriangleMesh& mesh, const std::vector<int>& sources);

}  // namespace rhizodont
