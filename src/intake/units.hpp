// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

namespace rhizodont {

/// A unit that scans come in.
struct Unit {
  const char* name;                    ///< in words, plural
  const char* option;                  ///< as the program's option has it
  double millimetres;                  ///< of one
  std::vector<const char*> spellings;  ///< others, lower case, singular
};

/// Those that are known, commonest first.
const std::vector<Unit>& known_units();

}  // namespace rhizodont
