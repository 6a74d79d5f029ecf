// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

#include <vector>

namespace rhizodont {

/// Vertices, in order, of a short closed loop of edges that goes round a handle or through it, so that the handle is
/// gone where the mesh is cut along it; empty for a mesh without handles. It is the shortest of the loops that start at
/// a few places on it, next to always the shortest of all. Takes n log n time. Deterministic.
/// Precondition: one piece, manifold and oriented, its border made of simple loops.
std::vector<int> short_handle_loop(const TriangleMesh& mesh);

}  // namespace rhizodont
