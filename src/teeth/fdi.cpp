// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "teeth/fdi.hpp"

#include "rhizodont/error.hpp"

#include <string>

namespace rhizodont {
namespace {

bool lies_within(int fdi, int first_quadrant, int last_quadrant, int places) {
  return fdi >= 0 && fdi / 10 >= first_quadrant && fdi / 10 <= last_quadrant && fdi % 10 >= 1 && fdi % 10 <= places;
}

}  // namespace

bool is_permanent_tooth(int fdi) { return lies_within(fdi, 1, 4, 8); }

bool is_milk_tooth(int fdi) { return lies_within(fdi, 5, 8, 5); }

std::optional<int> read_fdi(std::string_view text) {
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  if (text.size() != 2 || !is_digit(text[0]) || !is_digit(text[1])) return std::nullopt;
  const int fdi = 10 * (text[0] - '0') + (text[1] - '0');
  return is_permanent_tooth(fdi) || is_milk_tooth(fdi) ? std::optional(fdi) : std::nullopt;
}

int tooth_type_of_fdi(int fdi) {
  if (is_milk_tooth(fdi))
    throw UsageError(std::to_string(fdi) +
                     " is a milk tooth: roots are known of permanent teeth alone, 11-18, 21-28, 31-38, 41-48.");
  if (!is_permanent_tooth(fdi))
    throw UsageError(std::to_string(fdi) + " is not a permanent tooth: FDI numbers are 11-18, 21-28, 31-38, 41-48.");
  return (fdi / 10 > 2 ? 8 : 0) + fdi % 10 - 1;
}

bool is_right_side(int fdi) {
  tooth_type_of_fdi(fdi);
  return fdi / 10 == 1 || fdi / 10 == 4;
}

int fdi_of_type(int type, bool right_side) {
  if (type < 0 || type >= tooth_type_count) throw UsageError("Tooth types go from 0 to 15.");
  const int quadrant = type < 8 ? (right_side ? 1 : 2) : (right_side ? 4 : 3);
  return 10 * quadrant + type % 8 + 1;
}

}  // namespace rhizodont
