// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "command_line/output_options.hpp"

#include <filesystem>

namespace rhizodont::command_line {

/// Compares labels of scans with the true ones and gives figures, as `said` asks for them. `scans`: a folder of meshes
/// with SCAN.json (Teeth3DS) beside them; `found`: a folder with a SCAN.json each. A scan without found labels has no
/// tooth found. Throws InputError where there is no scan with true labels, and as the readers do.
void evaluate_labels(const std::filesystem::path& scans, const std::filesystem::path& found, const OutputOptions& said);

}  // namespace rhizodont::command_line
