// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"
#include "rhizodont/quality.hpp"

#include <optional>
#include <vector>

namespace rhizodont {

/// Q of one triangle, in [0, 1]; 0 for a triangle without area.
double triangle_quality(const TriangleMesh& mesh, std::size_t triangle);

/// Over the triangles with a true entry in `mask` (all without one). No value if there are none.
std::optional<QualityFigures> quality(const TriangleMesh& mesh);
std::optional<QualityFigures> quality(const TriangleMesh& mesh, const std::vector<bool>& mask);

}  // namespace rhizodont
