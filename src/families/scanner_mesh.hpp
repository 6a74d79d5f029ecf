// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

#include <cstdint>

namespace rhizodont {

/// A crown as an intraoral scanner gives it: triangles of about `edge_mm`, irregular, and noise along the normals.
/// @param crown    a disc with one border loop, millimetres
/// @param edge_mm  0.1..1
/// @param noise_mm standard deviation, 0..0.1
/// Coordinates are rounded to float. Throws NoResultError if the result is not a disc or intersects itself.
TriangleMesh scanner_mesh(const TriangleMesh& crown, double edge_mm, double noise_mm, std::uint64_t seed);

}  // namespace rhizodont
