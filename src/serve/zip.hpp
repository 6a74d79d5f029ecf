// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/output_files.hpp"

#include <string>
#include <vector>

namespace rhizodont::serve {

/// The files as a ZIP archive; of their paths the last part. All have one fixed date, so that equal files give equal
/// bytes. Throws std::runtime_error if the archive cannot be made.
std::string zip_bytes(const std::vector<OutputFile>& files);

}  // namespace rhizodont::serve
