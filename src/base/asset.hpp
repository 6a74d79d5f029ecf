// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

namespace rhizodont {

/// A file that is part of the program: cmake/RhizodontEmbed.cmake.
struct Asset {
  std::string_view name;  ///< "index.html", "samples/crown_36.stl"
  std::string_view bytes;
};

}  // namespace rhizodont
