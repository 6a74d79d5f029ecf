// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/check.hpp"
#include "rhizodont/complete.hpp"
#include "rhizodont/export.hpp"
#include "rhizodont/measure.hpp"

#include <string>
#include <string_view>

namespace rhizodont {

// Options and figures as JSON text, in the words of the report and of `check --json` and `measure --json`, for those
// who keep or send them. What comes back from the text is what went into it, to the last bit.

RHIZODONT_EXPORT std::string options_to_json(const CompleteOptions& options);
RHIZODONT_EXPORT std::string check_to_json(const CheckReport& report);
RHIZODONT_EXPORT std::string measures_to_json(const MeshMeasures& measures);

/// Names that are not in the text keep their defaults; a report's "options" is such a text. Ranges are checked where
/// the options are used. Throws UsageError for text that is no JSON object, a name that is no option's, or a value of
/// another kind, naming it.
RHIZODONT_EXPORT CompleteOptions options_from_json(std::string_view text);

/// Throw InputError for text that is not what `check_to_json` or `measures_to_json` writes, naming what is missing.
RHIZODONT_EXPORT CheckReport check_from_json(std::string_view text);
RHIZODONT_EXPORT MeshMeasures measures_from_json(std::string_view text);

}  // namespace rhizodont
