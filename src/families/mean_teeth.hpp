// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "completion/mean_crowns.hpp"
#include "families/tooth_family.hpp"

#include <cstddef>

namespace rhizodont {

/// The crown of a type's mean tooth (mean_tooth), cut just above the cemento-enamel junction: millimetres, in the
/// tooth's own frame. Throws NoResultError if it is not in one piece.
TriangleMesh mean_crown(const SyntheticTooth& mean);

/// The mean crowns and anchors of all types: the generator's teeth without variation, cut at the cemento-enamel
/// junction, in canonical pose. `points` (>= 64) oriented points per crown and as many anchors per tooth.
/// Throws UsageError if a type was not loaded.
Atlas make_atlas(const ToothFamilies& families, std::size_t points = 512);

}  // namespace rhizodont
