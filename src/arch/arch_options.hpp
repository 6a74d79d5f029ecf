// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/arch.hpp"

namespace rhizodont {

/// Throws UsageError, with a sentence, for options out of range and for what is each tooth's own to say.
void require_options_in_range(const ArchOptions& options);

/// Throws InputError, with a sentence, where the models' folder lacked what an arch with these options needs.
void require_models_of_arch(const CompletionModels& models, const ArchOptions& options);

}  // namespace rhizodont
