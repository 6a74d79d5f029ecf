// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "completion/frame.hpp"
#include "rhizodont/mesh.hpp"

#include <cstddef>
#include <optional>
#include <vector>

namespace rhizodont {

/// One of the 32 teeth, and how its mean crown lies on a crown.
struct ToothFit {
  std::size_t tooth = 0;  ///< 2 * type + (right side ? 1 : 0)
  RigidFit fit;
};

/// Lays the mean crowns of all types and sides on an open crown, roughly, and those of the `count` nearest anew and
/// better: the nearest as it seemed at first comes first. `also`: a tooth that is among them, and first, whatever its
/// distance. Deterministic. Throws as canonical_frame.
std::vector<ToothFit> lay_likely_teeth(const TriangleMesh& open_crown, const Atlas& atlas, std::size_t count,
                                       std::optional<std::size_t> also = {});

}  // namespace rhizodont
