// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "command_line/program.hpp"
#include "rhizodont/segment.hpp"

#include <string>
#include <vector>

namespace rhizodont::command_line {

/// What a person says of the teeth of a scan without labels.
struct FoundTeethOptions {
  std::string jaw;                   ///< "upper" or "lower"; empty: not said
  std::vector<std::string> missing;  ///< "14,24"
  std::vector<std::string> teeth;    ///< "24=x,y,z"

  /// Options --jaw, --missing and --tooth. They must outlive the command.
  void add_to(CLI::App& app);
  /// Throws UsageError for text that is none of these.
  void read_into(SegmentOptions& options) const;
};

}  // namespace rhizodont::command_line
