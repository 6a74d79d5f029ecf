// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "pictures/render.hpp"
#include "rhizodont/error.hpp"

#include <png.h>

namespace rhizodont {

std::string encode_png(const Image& image) {
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  header.width = static_cast<png_uint_32>(image.width);
  header.height = static_cast<png_uint_32>(image.height);
  header.format = PNG_FORMAT_RGB;
  // Room for the worst case: to ask for the size first would encode the picture twice.
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(header);
  std::string bytes(size, '\0');
  if (!png_image_write_to_memory(&header, bytes.data(), &size, 0, image.rgb.data(), 0, nullptr))
    throw Error(ErrorCode::internal, std::string("the picture cannot be encoded: ") + header.message);
  bytes.resize(size);
  return bytes;
}

}  // namespace rhizodont
