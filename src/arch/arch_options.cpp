// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "rhizodont/arch.hpp"

#include <algorithm>

namespace rhizodont {

bool has_size_of_arch(double millimetres_across, std::size_t teeth) {
  // Lower incisors, the smallest of teeth, are 5 mm wide, and an arch of 16 bends to a third of its length.
  return millimetres_across >= std::min(2.5 * static_cast<double>(teeth) + 1, 30.0) && millimetres_across <= 150;
}

CompleteOptions ArchOptions::skirt_and_repair() {
  CompleteOptions options;
  options.skirt = 0.5;
  options.repair = true;
  return options;
}

}  // namespace rhizodont
