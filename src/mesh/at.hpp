// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

namespace rhizodont {

/// The number of a vertex or triangle (>= 0) as the index of an array.
constexpr std::size_t at(int number) { return static_cast<std::size_t>(number); }

}  // namespace rhizodont
