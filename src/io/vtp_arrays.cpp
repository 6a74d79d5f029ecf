// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Arrays of VTK XML files ("VTK File Formats", Kitware): text, base64 or raw bytes, plain or in blocks packed with zlib
// or LZ4.
#include "io/vtp_arrays.hpp"

#include "io/base64.hpp"
#include "io/cursors.hpp"
#include "io/vtk_numbers.hpp"

#include <fmt/core.h>
#include <lz4.h>
#include <zlib.h>

#include <span>

namespace rhizodont {
namespace {

std::optional<VtkNumber> number_type(std::string_view name) {
  static constexpr std::array<std::string_view, 10> names{"Int8",   "UInt8", "Int16",  "UInt16",  "Int32",
                                                          "UInt32", "Int64", "UInt64", "Float32", "Float64"};
  const auto place = std::find(names.begin(), names.end(), name);
  if (place == names.end()) return std::nullopt;
  return static_cast<VtkNumber>(place - names.begin());
}

class ArrayReader {
 public:
  ArrayReader(const pugi::xml_node& node, VtkStorage& storage)
      : node_(node), storage_(storage), name_(node.attribute("Name").as_string("without a name")) {}

  VtkArray read() {
    const auto type = number_type(node_.attribute("type").as_string());
    if (!type) fail(fmt::format("is of type '{:.30}', which is not read", node_.attribute("type").as_string()));
    VtkArray array;
    array.type = attribute_type(*type);
    const int components = node_.attribute("NumberOfComponents").as_int(1);
    if (components < 1) fail("has no components");
    array.components = static_cast<std::size_t>(components);
    const std::string_view format = node_.attribute("format").as_string("ascii");
    if (format == "ascii")
      array.values = read_text(*type);
    else if (format == "binary")
      array.values = numbers_from(*type, unpack(decode_base64(node_.text().get())), storage_.byte_order);
    else if (format == "appended")
      array.values = numbers_from(*type, unpack_appended(), storage_.byte_order);
    else
      fail(fmt::format("is stored as '{:.30}', which is not read", format));
    return array;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("the array '{}' {}", name_, what));
  }

  std::vector<double> read_text(VtkNumber type) const {
    std::vector<double> values;
    TextCursor words(node_.text().get());
    while (const auto word = words.word()) {
      const auto value = number_from(type, *word);
      if (!value) fail(fmt::format("holds '{:.30}', which is not a number", *word));
      values.push_back(*value);
    }
    return values;
  }

  void take_room(std::uint64_t size) {
    if (size > storage_.room) fail("is not read: together the file's arrays hold far more than a mesh of its size");
    storage_.room -= size;
  }

  std::string unpack_appended() {
    const std::uint64_t offset = node_.attribute("offset").as_ullong(UINT64_MAX);
    if (offset >= storage_.appended.size()) fail("begins after the end of the file");
    const std::string_view rest = storage_.appended.substr(offset);
    if (storage_.appended_raw) return unpack(rest);
    take_room(rest.size());
    return unpack(decode_base64(rest));
  }

  std::uint64_t read_size(ByteCursor& cursor) const {
    if (cursor.remaining() < (storage_.wide_header ? 8U : 4U)) fail("is cut off");
    return storage_.wide_header ? cursor.read<std::uint64_t>() : cursor.read<std::uint32_t>();
  }

  // Takes off the sizes in front, and the compression.
  std::string unpack(std::string_view bytes) {
    ByteCursor cursor(bytes, storage_.byte_order);
    if (storage_.compression != VtkCompression::none) return inflate_blocks(bytes, cursor);
    const std::uint64_t size = read_size(cursor);
    if (size > cursor.remaining()) fail("is cut off");
    take_room(size);
    return std::string(bytes.substr(cursor.place(), size));
  }

  std::string inflate_blocks(std::string_view bytes, ByteCursor& cursor) {
    const std::uint64_t count = read_size(cursor), block_size = read_size(cursor), last_size = read_size(cursor);
    if (count > cursor.remaining() / 4) fail("is cut off");
    std::vector<std::uint64_t> packed_sizes(count);
    for (std::uint64_t& size : packed_sizes) size = read_size(cursor);
    std::string unpacked;
    for (std::size_t k = 0; k < packed_sizes.size(); ++k) {
      const std::uint64_t size = k + 1 == count && last_size > 0 ? last_size : block_size;
      if (packed_sizes[k] > cursor.remaining()) fail("is cut off");
      // zlib packs at most about 1 : 1032, LZ4 1 : 255; a larger promise is a lie and would only cost memory
      if (size > 1100 * packed_sizes[k] + 64) fail("is damaged");
      take_room(size);
      const std::size_t start = unpacked.size();
      unpacked.resize(start + size);
      if (!unpack_block({bytes.data() + cursor.place(), packed_sizes[k]}, {unpacked.data() + start, size}))
        fail("is damaged: its compressed data cannot be unpacked");
      cursor.skip(packed_sizes[k]);
    }
    return unpacked;
  }

  // False if the block is not of just that size. Where the named way of packing does not fit, the other one is tried:
  // programs have been seen to write one and name the other.
  bool unpack_block(std::string_view packed, std::span<char> unpacked) const {
    if (storage_.compression == VtkCompression::lz4)
      return unpack_lz4(packed, unpacked) || unpack_zlib(packed, unpacked);
    return unpack_zlib(packed, unpacked) || unpack_lz4(packed, unpacked);
  }

  static bool unpack_lz4(std::string_view packed, std::span<char> unpacked) {
    if (std::max(packed.size(), unpacked.size()) > std::size_t{INT32_MAX}) return false;
    const int length = LZ4_decompress_safe(packed.data(), unpacked.data(), static_cast<int>(packed.size()),
                                           static_cast<int>(unpacked.size()));
    return length >= 0 && static_cast<std::size_t>(length) == unpacked.size();
  }

  static bool unpack_zlib(std::string_view packed, std::span<char> unpacked) {
    auto length = static_cast<uLongf>(unpacked.size());
    const int outcome = uncompress(reinterpret_cast<Bytef*>(unpacked.data()), &length,
                                   reinterpret_cast<const Bytef*>(packed.data()), static_cast<uLong>(packed.size()));
    return outcome == Z_OK && length == unpacked.size();
  }

  const pugi::xml_node& node_;
  VtkStorage& storage_;
  std::string name_;
};

}  // namespace

VtkArray read_vtk_array(const pugi::xml_node& node, VtkStorage& storage) { return ArrayReader(node, storage).read(); }

}  // namespace rhizodont
