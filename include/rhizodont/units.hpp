// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/export.hpp"

#include <string>

namespace rhizodont {

/// A unit in words ("millimetres"), or its millimetres ("3 mm") where it has no name here.
RHIZODONT_EXPORT std::string unit_in_words(double millimetres_per_unit);

/// The millimetres of a unit by its name, in any usual spelling: "mm", "Inches", "um". Throws UsageError for others.
RHIZODONT_EXPORT double millimetres_per_unit(const std::string& name);

}  // namespace rhizodont
