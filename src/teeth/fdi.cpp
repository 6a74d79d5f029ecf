// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "teeth/fdi.hpp"

#include "rhizodont/error.hpp"

#include <string>

namespace rhizodont {

int tooth_type_of_fdi(int fdi) {
  const int quadrant = fdi / 10, position = fdi % 10;
  if (fdi < 0 || quadrant < 1 || quadrant > 4 || position < 1 || position > 8)
    throw UsageError(std::to_string(fdi) + " is not a permanent tooth: FDI numbers are 11-18, 21-28, 31-38, 41-48.");
  return (quadrant > 2 ? 8 : 0) + position - 1;
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
