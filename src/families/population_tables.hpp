// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

namespace rhizodont {

/// populations/middle.json.
extern const std::string_view middle_population_table;

}  // namespace rhizodont
