// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/arch.hpp"

namespace rhizodont {

/// Throws UsageError, with a sentence, for options out of range and for what is each tooth's own to say.
void require_options_in_range(const ArchOptions& options);

}  // namespace rhizodont
