// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "completion/mean_crowns.hpp"
#include "teeth/prepared_crown.hpp"

#include <cstddef>
#include <vector>

namespace rhizodont {

/// How a crown and a tooth's mean crown agree where the one lies on the other.
struct MeanCrownAgreement {
  double distance_mm = 0;  ///< mean distance, both ways, at the crown's own size
  double seen = 0;         ///< share of the mean crown with crown surface near it, 0..1
  double explained = 0;    ///< share of the crown's surface with the mean crown near it, 0..1
};

/// Agreement with some of the 32 teeth (2 * type + (right side ? 1 : 0)), in their order. Near means within 1 mm of the
/// mean crown's size, facing the same way. Deterministic. Throws as canonical_frame.
std::vector<MeanCrownAgreement> mean_crown_agreement(const PreparedCrown& crown, const Atlas& atlas,
                                                     const std::vector<std::size_t>& teeth);

}  // namespace rhizodont
