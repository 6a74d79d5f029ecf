// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string_view>

namespace rhizodont {

/// Number of tooth types: upper 1..8 are 0..7, lower 1..8 are 8..15; left and right share a type.
inline constexpr int tooth_type_count = 16;
/// 11-18, 21-28, 31-38, 41-48 (FDI, ISO 3950).
bool is_permanent_tooth(int fdi);
/// 51-55, 61-65, 71-75, 81-85.
bool is_milk_tooth(int fdi);
/// The number of a permanent or a milk tooth written in two digits; nothing for other text.
std::optional<int> read_fdi(std::string_view text);
/// Type 0..15 of a permanent tooth. Throws UsageError for other numbers.
int tooth_type_of_fdi(int fdi);
/// True if the number names a permanent tooth of the right side (quadrants 1 and 4). Throws UsageError for others.
bool is_right_side(int fdi);
/// FDI number of a type on the left (quadrants 2 and 3) or right (1 and 4) side.
int fdi_of_type(int type, bool right_side);

}  // namespace rhizodont
