// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>

namespace rhizodont {

/// Said by every reader of files that have such colours.
inline constexpr const char* triangle_colours_note = "The file's colours per triangle are not read.";
inline constexpr const char* triangle_colours_kept_note =
    "The file's colours per triangle can serve as labels; a completed tooth does not carry them.";
inline constexpr const char* texture_note = "The file's texture is not read; colours per vertex would be.";

/// "1 polygon was" or "7 polygons were", to begin a sentence with.
inline std::string counted(std::size_t count, const char* one, const char* several) {
  return std::to_string(count) + " " + (count == 1 ? one : several);
}

}  // namespace rhizodont
