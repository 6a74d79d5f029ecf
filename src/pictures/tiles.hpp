// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pictures/render.hpp"

#include <cstddef>

namespace rhizodont {

/// The rows of a picture (such as `render` gives, a mesh each) set side by side: `per_row` of them to a row, what is
/// left of the last row white. Preconditions: `rows` >= 1 and divides the picture's height, `per_row` >= 1.
Image side_by_side(const Image& tall, std::size_t rows, std::size_t per_row);

}  // namespace rhizodont
