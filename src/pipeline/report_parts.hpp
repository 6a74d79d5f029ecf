// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/complete.hpp"

#include <vector>

namespace rhizodont {

/// Vertices of the input that were dropped because they are not the tooth's, such as those of a cap or a skirt; not
/// those that a repair dropped.
std::vector<int> vertices_not_of_tooth(const CompletionRecord& record);

}  // namespace rhizodont
