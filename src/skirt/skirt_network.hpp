// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "networks/surface_network.hpp"
#include "rhizodont/mesh.hpp"

#include <vector>

namespace rhizodont {

struct SkirtNetworkOptions {
  int most_vertices = 3500;  ///< >= 200: crowns with more are judged on a decimated copy
};

/// Per vertex how sure the network is that it is tooth and not skirt, 0..1. A crown with more vertices than
/// `options.most_vertices` is judged on a copy with so many, and what was found carried back to the nearest places of
/// its surface: skirts are wider than the copy's triangles. `crown`: one piece, oriented, open, in mm. Deterministic.
/// Throws as `skirt_features`, UsageError for bad options.
std::vector<float> skirt_confidence(const TriangleMesh& crown, const SurfaceNetwork& network,
                                    const SkirtNetworkOptions& options = {});

/// The crown with about `vertices` vertices and the same topology; unchanged if it has no more or is no manifold.
TriangleMesh decimated(const TriangleMesh& crown, std::size_t vertices);

}  // namespace rhizodont
