// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "base/random_stream.hpp"
#include "families/tooth_family.hpp"

#include <optional>

namespace rhizodont {

/// Life's marks on a crown: wear of cusps and edges, a decay cavity or a lost corner, a bracket or attachment on the
/// cheek's side. Moves vertices of `tooth.mesh` in place; needs mesh and crown labels, in the tooth's frame.
/// @param wear_rank  standard normal; the highest, as many as ToothVariation::wear_share says, are worn, the more the
///                   higher. None: drawn.
void mark_crown(SyntheticTooth& tooth, const ToothVariation& variation, const std::optional<double>& wear_rank,
                RandomStream& random);

}  // namespace rhizodont
