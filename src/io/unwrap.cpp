// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/unwrap.hpp"

#include "rhizodont/error.hpp"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

namespace rhizodont {
namespace {

constexpr std::size_t always_allowed = std::size_t{64} << 20, never_allowed = std::size_t{1} << 30, largest_ratio = 200;
constexpr std::string_view gzip_magic = "\x1f\x8b\x08";

/// zlib's state, released in the end.
class Inflation {
 public:
  Inflation() {
    if (inflateInit2(&stream, 16 + MAX_WBITS) != Z_OK) throw std::bad_alloc();
  }
  Inflation(const Inflation&) = delete;
  Inflation& operator=(const Inflation&) = delete;
  ~Inflation() { inflateEnd(&stream); }

  z_stream stream{};
};

std::string inflate_gzip(std::string_view packed) {
  const std::size_t bound = std::min(never_allowed, std::max(always_allowed, largest_ratio * packed.size()));
  Inflation inflation;
  z_stream& stream = inflation.stream;
  std::string unpacked;
  std::string_view rest = packed;
  while (rest.starts_with(gzip_magic)) {  // members one after the other; what follows them is passed over
    inflateReset(&stream);
    int outcome = Z_OK;
    while (outcome == Z_OK) {
      if (unpacked.size() >= bound)
        throw InputError("the packed file holds far more than a mesh of its size: it is not unpacked any further");
      const std::size_t start = unpacked.size();
      unpacked.resize(start + std::clamp<std::size_t>(start, 65536, std::size_t{1} << 24));
      const std::size_t chunk = std::min<std::size_t>(rest.size(), std::numeric_limits<uInt>::max());
      stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(rest.data()));
      stream.avail_in = static_cast<uInt>(chunk);
      stream.next_out = reinterpret_cast<Bytef*>(unpacked.data() + start);
      stream.avail_out = static_cast<uInt>(unpacked.size() - start);
      outcome = inflate(&stream, Z_NO_FLUSH);
      rest.remove_prefix(chunk - stream.avail_in);
      unpacked.resize(unpacked.size() - stream.avail_out);
      if (outcome == Z_BUF_ERROR || (outcome == Z_OK && rest.empty() && stream.avail_out > 0))
        throw InputError("the packed file (gzip) is cut off");
    }
    if (outcome != Z_STREAM_END) throw InputError("the packed file (gzip) is damaged");
  }
  return unpacked;
}

bool is_plain_letter(unsigned char c) { return (c >= 32 && c < 127) || (c >= '\t' && c <= '\r'); }

/// Byte order of a UTF-16 text; nothing for other bytes. Without a byte order mark the first letters must be plain.
std::optional<std::endian> utf16_order(std::string_view bytes) {
  if (bytes.starts_with("\xff\xfe")) return std::endian::little;
  if (bytes.starts_with("\xfe\xff")) return std::endian::big;
  if (bytes.size() < 16) return std::nullopt;
  for (const std::size_t low : {std::size_t{0}, std::size_t{1}}) {
    bool fits = true;
    for (std::size_t k = 0; k + 1 < std::min<std::size_t>(bytes.size(), 64); k += 2)
      fits &= is_plain_letter(static_cast<unsigned char>(bytes[k + low])) && bytes[k + 1 - low] == '\0';
    if (fits) return low == 0 ? std::endian::little : std::endian::big;
  }
  return std::nullopt;
}

void append_utf8(std::string& text, std::uint32_t letter) {
  const auto add = [&](std::uint32_t byte) { text.push_back(static_cast<char>(byte)); };
  if (letter < 0x80) return add(letter);
  if (letter < 0x800) {
    add(0xc0 | letter >> 6);
  } else if (letter < 0x10000) {
    add(0xe0 | letter >> 12);
    add(0x80 | (letter >> 6 & 0x3f));
  } else {
    add(0xf0 | letter >> 18);
    add(0x80 | (letter >> 12 & 0x3f));
    add(0x80 | (letter >> 6 & 0x3f));
  }
  add(0x80 | (letter & 0x3f));
}

std::string utf8_of(std::string_view utf16, std::endian order) {
  std::string text;
  text.reserve(utf16.size() / 2);
  const auto unit = [&](std::size_t place) {
    const auto first = static_cast<unsigned char>(utf16[place]), second = static_cast<unsigned char>(utf16[place + 1]);
    return static_cast<std::uint32_t>(order == std::endian::little ? first | second << 8 : second | first << 8);
  };
  for (std::size_t k = 0; k + 1 < utf16.size(); k += 2) {
    std::uint32_t letter = unit(k);
    const bool has_second = letter >= 0xd800 && letter < 0xdc00 && k + 3 < utf16.size();
    if (has_second && unit(k + 2) >= 0xdc00 && unit(k + 2) < 0xe000) {
      letter = 0x10000 + ((letter - 0xd800) << 10) + (unit(k + 2) - 0xdc00);
      k += 2;
    } else if (letter >= 0xd800 && letter < 0xe000) {
      letter = 0xfffd;  // half a letter
    }
    append_utf8(text, letter);
  }
  return text;
}

}  // namespace

void unwrap(std::string_view bytes, Unwrapped& result) {
  result.bytes = bytes;
  const auto take = [&](std::string content) {
    result.storage = std::move(content);
    result.bytes = result.storage;
  };
  for (int layer = 0; result.bytes.starts_with(gzip_magic); ++layer) {
    if (layer == 2) throw InputError("the file is packed (gzip) several times over: unpack it first");
    take(inflate_gzip(result.bytes));
    if (layer == 0) result.notes.emplace_back("The file was packed with gzip.");
  }
  using namespace std::string_view_literals;
  if (result.bytes.starts_with("\xff\xfe\0\0"sv) || result.bytes.starts_with("\0\0\xfe\xff"sv))
    throw InputError("the file is text in UTF-32: save it as UTF-8");
  if (const auto order = utf16_order(result.bytes)) {
    take(utf8_of(result.bytes, *order));
    result.notes.emplace_back("The file is text in UTF-16 and was read as that; for other programs, save it as UTF-8.");
  }
  if (result.bytes.starts_with("\xef\xbb\xbf")) result.bytes.remove_prefix(3);
}

}  // namespace rhizodont
