// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

#include <optional>
#include <vector>

namespace rhizodont {

/// Triangles that close a hole over its border vertices and meet neither the mesh nor each other. The search prefers
/// small bends, then small area, and need not find the best. Nothing if it finds none within a bounded effort; for
/// holes of more than 250 vertices nothing is tried.
/// @param mesh  manifold, its triangles not cutting each other; `hole`: the vertices of a border loop, one after the
///              other as the new triangles go around (against the mesh's own triangles)
std::optional<std::vector<Triangle>> clear_filling(const TriangleMesh& mesh, const std::vector<int>& hole);

}  // namespace rhizodont
