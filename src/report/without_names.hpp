// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace rhizodont {

/// A sentence about files that quotes neither their names, in any form that a reader or the system gives them, nor
/// words that stand in them: what is between single quotes goes too, but for the words of formats. Names and headers of
/// scans tell of patients.
std::string without_names(std::string sentence, const std::vector<std::filesystem::path>& files);

}  // namespace rhizodont
