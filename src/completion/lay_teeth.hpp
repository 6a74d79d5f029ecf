// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "completion/mean_crowns.hpp"
#include "completion/registration.hpp"
#include "rhizodont/mesh.hpp"

#include <cstddef>
#include <vector>

namespace rhizodont {

/// Lays the mean crowns of some of the 32 teeth (2 * type + (right side ? 1 : 0)) on an open crown: one fit for each,
/// in their order. Deterministic. Throws as canonical_frame.
std::vector<RigidFit> lay_teeth(const PreparedCrown& crown, const Atlas& atlas, const std::vector<std::size_t>& teeth);

}  // namespace rhizodont
