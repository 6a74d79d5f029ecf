// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

namespace rhizodont::command_line {

/// What --skirt takes: keep (nothing), auto, or the confidence from which a vertex is tooth. Throws UsageError.
std::optional<double> skirt_threshold(const std::string& text);

}  // namespace rhizodont::command_line
