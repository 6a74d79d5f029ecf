// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace rhizodont {

/// Number of tooth types: upper 1..8 are 0..7, lower 1..8 are 8..15; left and right share a type.
inline constexpr int tooth_type_count = 16;
/// Type 0..15 of an FDI number (11-18, 21-28, 31-38, 41-48). Throws UsageError for other numbers.
int tooth_type_of_fdi(int fdi);
/// True if the FDI number names a tooth of the right side (quadrants 1 and 4). Throws UsageError for other numbers.
bool is_right_side(int fdi);
/// FDI number of a type on the left (quadrants 2 and 3) or right (1 and 4) side.
int fdi_of_type(int type, bool right_side);

}  // namespace rhizodont
