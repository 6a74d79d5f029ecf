// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "base/asset.hpp"

#include <string_view>
#include <vector>

namespace rhizodont {

/// The page (if it was built), the samples and the description of the API.
const std::vector<Asset>& service_assets();

namespace serve {

/// Null if there is none of this name.
const Asset* find_asset(std::string_view name);

/// By the name's ending.
const char* media_type(std::string_view name);

}  // namespace serve

}  // namespace rhizodont
