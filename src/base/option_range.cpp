// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/option_range.hpp"

#include "rhizodont/error.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>

namespace rhizodont {
namespace {

std::string in_words(const OptionRange& range) {
  std::string words = fmt::format("{} {}", range.low_belongs() ? "at least" : "above", range.low());
  if (std::isfinite(range.high()))
    words += fmt::format(" and {} {}", range.high_belongs() ? "at most" : "below", range.high());
  return words;
}

}  // namespace

bool OptionRange::contains(double value) const {
  return (low_belongs_ ? value >= low_ : value > low_) && (high_belongs_ ? value <= high_ : value < high_);
}

void require_ranges(std::string_view of, std::initializer_list<RangedOption> options) {
  for (const RangedOption& option : options)
    if (!option.range.contains(option.value))
      throw UsageError(fmt::format("The option {} of {} is {}, out of its range: {}.", option.name, of, option.value,
                                   in_words(option.range)));
}

}  // namespace rhizodont
