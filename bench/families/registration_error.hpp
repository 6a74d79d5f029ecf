// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "families/tooth_family.hpp"

#include <cstdint>

namespace rhizodont {

/// Prints a table of how well generated crowns are laid on the mean crown of their type: the turn about the growth axis
/// and the axis of the crown's form, against what the generator knows. `count` crowns per type, >= 2. The registered
/// lean would be the true one with a slope of 1, no bias and no rest.
void registration_table(const ToothFamilies& families, std::uint64_t count);

}  // namespace rhizodont
