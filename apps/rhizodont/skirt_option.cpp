// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "skirt_option.hpp"

#include "io/cursors.hpp"
#include "rhizodont/error.hpp"

#include <charconv>

namespace rhizodont::command_line {

std::optional<double> skirt_threshold(const std::string& text) {
  if (same_word(text, "keep")) return std::nullopt;
  if (same_word(text, "auto")) return 0.5;
  double value = 0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (failure != std::errc() || end != text.data() + text.size() || !(value > 0 && value < 1))
    throw UsageError("--skirt takes keep, auto, or a confidence between 0 and 1.");
  return value;
}

}  // namespace rhizodont::command_line
