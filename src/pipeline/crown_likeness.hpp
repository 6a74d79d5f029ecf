// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "completion/likeness.hpp"
#include "completion/mean_crowns.hpp"
#include "rhizodont/complete.hpp"
#include "teeth/prepared_crown.hpp"

#include <optional>

namespace rhizodont {

/// Which tooth a crown looks like, and whether it looks like the one it is said to be.
/// @param crown  open at its base, mm
/// @param fdi    the tooth it is said to be; unset: the most probable one is taken
/// Throws InputError for what looks like none of the 32 teeth, and as `likeness`.
CrownLikeness judge_crown(const PreparedCrown& crown, std::optional<int> fdi, const Atlas& atlas,
                          const LikenessModel& model);

/// A sentence for the user, or nothing for a crown that looks like the tooth it is said to be. `guessed`: nobody said
/// what it is.
std::optional<std::string> likeness_warning(const CrownLikeness& likeness, bool guessed);

}  // namespace rhizodont
