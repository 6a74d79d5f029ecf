// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

namespace rhizodont {

/// True if triangles cross each other: a quick answer in rounded arithmetic for meshes of millimetre size with
/// triangles of similar size, a few milliseconds for 10,000. Triangles that share an edge, and those around a vertex
/// that face alike, are taken to be apart. `self_intersecting_triangles` is the exact and slow test.
bool crosses_itself(const TriangleMesh& mesh);

}  // namespace rhizodont
