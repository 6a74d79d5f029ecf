// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

#include <cstdint>
#include <string>
#include <vector>

// Crowns as a segmentation leaves them, made from a labelled crown with a skirt and a seed.
namespace rhizodont::test {

/// Names of what `raw_crown` adds, in a fixed order: "plain" adds nothing, "combination" three to five kinds.
std::vector<std::string> raw_kinds();

/// A crown with its skirt, and in the part that is not the tooth's own surface what segmentations leave there: bridges
/// and tubes, slits, holes, pieces beside it, vertices where it only touches itself (up to nine), edges with three
/// triangles, folds that cut the surface, borders that run along single triangles. The tooth's own surface has no
/// defect. `is_tooth`: per vertex, 1 on the tooth's own surface, as of `make_skirt_sample`. Depends on the arguments
/// alone. Throws UsageError for an unknown kind.
TriangleMesh raw_crown(const TriangleMesh& crown, const std::vector<std::uint8_t>& is_tooth, const std::string& kind,
                       std::uint64_t seed);

}  // namespace rhizodont::test
