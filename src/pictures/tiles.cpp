// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "pictures/tiles.hpp"

#include <algorithm>
#include <cassert>

namespace rhizodont {

Image side_by_side(const Image& tall, std::size_t rows, std::size_t per_row) {
  assert(rows >= 1 && per_row >= 1 && static_cast<std::size_t>(tall.height) % rows == 0);
  const std::size_t height = static_cast<std::size_t>(tall.height) / rows;
  const std::size_t bytes = 3 * static_cast<std::size_t>(tall.width), rows_of_wide = (rows + per_row - 1) / per_row;
  Image wide;
  wide.width = tall.width * static_cast<int>(per_row);
  wide.height = static_cast<int>(height * rows_of_wide);
  wide.rgb.assign(bytes * per_row * height * rows_of_wide, 255);
  for (std::size_t i = 0; i < rows; ++i)
    for (std::size_t y = 0; y < height; ++y)
      std::copy_n(tall.rgb.begin() + static_cast<std::ptrdiff_t>((i * height + y) * bytes), bytes,
                  wide.rgb.begin() +
                      static_cast<std::ptrdiff_t>((((i / per_row) * height + y) * per_row + i % per_row) * bytes));
  return wide;
}

}  // namespace rhizodont
