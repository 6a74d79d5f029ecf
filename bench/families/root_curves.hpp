// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "families/tooth_family.hpp"

#include <cstdint>

namespace rhizodont {

/// Schneider's angles of generated roots by tooth and root, `count` teeth of each type: as drawn, and without the
/// curves and sharp turns of the population.
void curve_table(const ToothFamilies& families, std::uint64_t count);

}  // namespace rhizodont
