// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

namespace rhizodont {

/// Samples with numbers from here on belong to validation and are never trained on.
inline constexpr std::uint64_t first_validation_sample = std::uint64_t{1} << 40;

}  // namespace rhizodont
