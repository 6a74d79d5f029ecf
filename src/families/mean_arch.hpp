// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "completion/mean_crowns.hpp"
#include "segment/arch_model.hpp"

#include <filesystem>

namespace rhizodont {

/// The mean arch as the statistical crown models have it: where their mean crowns stand, and how the mean crown of the
/// atlas lies on each. Left and right are made alike. Reads folder/ssm/crown_ssm_FDI.safetensors and
/// folder/arch_covariances.safetensors. Throws InputError where a file is missing or damaged.
ArchModel make_arch_model(const Atlas& atlas, const std::filesystem::path& folder);

}  // namespace rhizodont
