// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/export.hpp"

#include <string>
#include <string_view>

namespace rhizodont {

/// SHA-256 in lower-case hex.
RHIZODONT_EXPORT std::string sha256_of_bytes(std::string_view bytes);

}  // namespace rhizodont
