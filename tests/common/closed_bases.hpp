// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

#include <cstdint>
#include <string>
#include <vector>

// Crowns closed over their base as programs do it.
namespace rhizodont::test {

/// fan, cone, ears, corner fan, rings, flat, block, tapered block, plain block, uneven block.
std::vector<std::string> base_kinds();

/// The open crown closed over its longest border loop. Its triangles come first, those that close it after them, or,
/// with a seed, all triangles and vertices in an order at random; `is_cap` says which close it. "flat" cuts the crown
/// by a plane above its border first (at an edge's length), so that the border is even.
struct ClosedCrown {
  TriangleMesh mesh;
  std::vector<bool> is_cap;
};
ClosedCrown closed_base(const TriangleMesh& open_crown, const std::string& kind, std::uint64_t shuffling_seed = 0);

}  // namespace rhizodont::test
