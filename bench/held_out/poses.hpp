// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "families/tooth_family.hpp"
#include "rhizodont/models.hpp"

#include <cstddef>

namespace rhizodont {

/// Prints how far off crowns of so many generated people are laid, by how much their borders lean against their form,
/// and what that costs: the network's points below the border beside those that it predicts from the true pose.
void print_poses(const ToothFamilies& families, const CompletionModels& models, std::size_t people);

}  // namespace rhizodont
