// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <concepts>
#include <initializer_list>
#include <limits>
#include <string_view>

namespace rhizodont {

/// Where the value of an option may lie; what is not a number, and without an upper bound what is infinite, lies
/// outside.
class OptionRange {
 public:
  static constexpr OptionRange at_least(double low) { return {low, true}; }
  static constexpr OptionRange above(double low) { return {low, false}; }
  constexpr OptionRange at_most(double high) const { return {low_, low_belongs_, high, true}; }
  constexpr OptionRange below(double high) const { return {low_, low_belongs_, high, false}; }

  bool contains(double value) const;
  double low() const { return low_; }
  bool low_belongs() const { return low_belongs_; }
  double high() const { return high_; }
  bool high_belongs() const { return high_belongs_; }

 private:
  constexpr OptionRange(double low, bool low_belongs, double high = std::numeric_limits<double>::infinity(),
                        bool high_belongs = false)
      : low_(low), high_(high), low_belongs_(low_belongs), high_belongs_(high_belongs) {}

  double low_, high_;
  bool low_belongs_, high_belongs_;
};

inline constexpr OptionRange share_range = OptionRange::at_least(0).at_most(1);

/// An option's value beside where it may lie.
struct RangedOption {
  template <class Number>
  requires std::integral<Number> || std::floating_point<Number> RangedOption(std::string_view the_name,
                                                                             Number the_value,
                                                                             const OptionRange& the_range)
      : name(the_name), value(static_cast<double>(the_value)), range(the_range) {}

  std::string_view name;  ///< as the options struct has it
  double value;
  OptionRange range;
};

/// Throws UsageError for the first option out of its range, with name, value and range. `of`: what the options are of,
/// as in "of the seam".
void require_ranges(std::string_view of, std::initializer_list<RangedOption> options);

}  // namespace rhizodont
