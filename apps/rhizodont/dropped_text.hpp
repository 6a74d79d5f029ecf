// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/dropped_vertex.hpp"

#include <string>
#include <vector>

namespace rhizodont::command_line {

/// "12 vertices dropped as skirt, 3 as pinched border"; empty if there are none. Those of repairs are left out: each
/// repair is told by itself.
std::string dropped_text(const std::vector<DroppedCrownVertex>& dropped);

}  // namespace rhizodont::command_line
