// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "completion/likeness.hpp"

namespace rhizodont {

/// The numbers by which one tooth judges: agreements, the offsets' coordinates along the type's modes, and the
/// logarithm of what the modes leave of them.
Eigen::VectorXd likeness_vector(const CrownTraits& traits, const TypeStatistics& type);

/// The same as deviations from the type's own mean in its own standard deviations, the outermost pulled in.
Eigen::VectorXd standardised(const Eigen::VectorXd& vector, const TypeStatistics& type);

}  // namespace rhizodont
