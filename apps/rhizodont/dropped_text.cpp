// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "dropped_text.hpp"

#include <fmt/core.h>

#include <cstddef>
#include <map>

namespace rhizodont::command_line {

std::string dropped_text(const std::vector<DroppedCrownVertex>& dropped) {
  std::map<DropReason, std::size_t> counts;
  for (const DroppedCrownVertex& one : dropped)
    if (one.reason != DropReason::repair) ++counts[one.reason];
  std::string text;
  for (const auto& [reason, count] : counts)
    text += text.empty()
                ? fmt::format("{} {} dropped as {}", count, count == 1 ? "vertex" : "vertices", reason_text(reason))
                : fmt::format(", {} as {}", count, reason_text(reason));
  return text;
}

}  // namespace rhizodont::command_line
