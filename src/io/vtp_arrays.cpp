// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Arrays of VTK XML files ("VTK File Formats", Kitware): text, base64 or raw bytes, plain or in zlib blocks.
#include "io/vtp_arrays.hpp"

#include "io/attribute_types.hpp"
#include "io/base64.hpp"
#include "io/cursors.hpp"

#include <fmt/core.h>
#include <zlib.h>

#include <cmath>

namespace rhizodont {
namespace {

enum class Stored { int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32, float64 };

std::optional<Stored> stored_type(std::string_view name) {
  static constexpr std::array<std::string_view, 10> names{"Int8",   "UInt8", "Int16",  "UInt16",  "Int32",
                                                          "UInt32", "Int64", "UInt64", "Float32", "Float64"};
  const auto place = std::find(names.begin(), names.end(), name);
  if (place == names.end()) return std::nullopt;
  return static_cast<Stored>(place - names.begin());
}

AttributeType attribute_type(Stored stored) {
  switch (stored) {
    case Stored::int8:
      return AttributeType::int8;
    case Stored::uint8:
      return AttributeType::uint8;
    case Stored::int16:
      return AttributeType::int16;
    case Stored::uint16:
      return AttributeType::uint16;
    case Stored::int32:
      return AttributeType::int32;
    case Stored::uint32:
      return AttributeType::uint32;
    case Stored::float32:
      return AttributeType::float32;
    default:
      return AttributeType::float64;
  }
}

template <class Number>
std::vector<double> numbers(const std::string& bytes, std::endian order) {
  ByteCursor cursor(bytes, order);
  std::vector<double> values(bytes.size() / sizeof(Number));
  for (double& value : values) value = static_cast<double>(cursor.read<Number>());
  return values;
}

std::vector<double> numbers(Stored stored, const std::string& bytes, std::endian order) {
  if (stored == Stored::int64) return numbers<std::int64_t>(bytes, order);
  if (stored == Stored::uint64) return numbers<std::uint64_t>(bytes, order);
  return with_attribute_type(attribute_type(stored), [&](auto kind) { return numbers<decltype(kind)>(bytes, order); });
}

class ArrayReader {
 public:
  ArrayReader(const pugi::xml_node& node, const VtkStorage& storage)
      : node_(node), storage_(storage), name_(node.attribute("Name").as_string("without a name")) {}

  VtkArray read() {
    const auto stored = stored_type(node_.attribute("type").as_string());
    if (!stored) fail(fmt::format("is of type '{:.30}', which is not read", node_.attribute("type").as_string()));
    VtkArray array;
    array.type = attribute_type(*stored);
    const int components = node_.attribute("NumberOfComponents").as_int(1);
    if (components < 1) fail("has no components");
    array.components = static_cast<std::size_t>(components);
    const std::string_view format = node_.attribute("format").as_string("ascii");
    if (format == "ascii")
      array.values = read_text(*stored);
    else if (format == "binary")
      array.values = numbers(*stored, unpack(decode_base64(node_.text().get())), storage_.byte_order);
    else if (format == "appended")
      array.values = numbers(*stored, unpack(appended_bytes()), storage_.byte_order);
    else
      fail(fmt::format("is stored as '{:.30}', which is not read", format));
    return array;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("the array '{}' {}", name_, what));
  }

  std::vector<double> read_text(Stored stored) const {
    std::vector<double> values;
    TextCursor words(node_.text().get());
    while (const auto word = words.word()) {
      const auto value = stored == Stored::float32 ? widened(parse_number<float>(*word)) : parse_number<double>(*word);
      if (!value) fail(fmt::format("holds '{:.30}', which is not a number", *word));
      values.push_back(*value);
    }
    return values;
  }

  static std::optional<double> widened(std::optional<float> value) {
    if (!value) return std::nullopt;
    return static_cast<double>(*value);
  }

  std::string appended_bytes() const {
    const std::uint64_t offset = node_.attribute("offset").as_ullong(UINT64_MAX);
    if (offset >= storage_.appended.size()) fail("begins after the end of the file");
    const std::string_view rest = storage_.appended.substr(offset);
    return storage_.appended_raw ? std::string(rest) : decode_base64(rest);
  }

  std::uint64_t read_size(ByteCursor& cursor) const {
    if (cursor.remaining() < (storage_.wide_header ? 8U : 4U)) fail("is cut off");
    return storage_.wide_header ? cursor.read<std::uint64_t>() : cursor.read<std::uint32_t>();
  }

  // Takes off the sizes in front, and the compression.
  std::string unpack(const std::string& bytes) const {
    ByteCursor cursor(bytes, storage_.byte_order);
    if (storage_.compressed) return inflate_blocks(bytes, cursor);
    const std::uint64_t size = read_size(cursor);
    if (size > cursor.remaining()) fail("is cut off");
    return bytes.substr(cursor.place(), size);
  }

  std::string inflate_blocks(const std::string& bytes, ByteCursor& cursor) const {
    const std::uint64_t count = read_size(cursor), block_size = read_size(cursor), last_size = read_size(cursor);
    if (count > cursor.remaining() / 4) fail("is cut off");
    std::vector<std::uint64_t> packed_sizes(count);
    for (std::uint64_t& size : packed_sizes) size = read_size(cursor);
    std::string unpacked;
    for (std::size_t k = 0; k < packed_sizes.size(); ++k) {
      const std::uint64_t size = k + 1 == count && last_size > 0 ? last_size : block_size;
      if (packed_sizes[k] > cursor.remaining()) fail("is cut off");
      // zlib packs at most about 1 : 1032; a larger promise is a lie and would only cost memory
      if (size > 1100 * packed_sizes[k] + 64) fail("is damaged");
      const std::size_t start = unpacked.size();
      unpacked.resize(start + size);
      auto length = static_cast<uLongf>(size);
      const int outcome = uncompress(reinterpret_cast<Bytef*>(unpacked.data() + start), &length,
                                     reinterpret_cast<const Bytef*>(bytes.data() + cursor.place()),
                                     static_cast<uLong>(packed_sizes[k]));
      if (outcome != Z_OK || length != size) fail("is damaged: its compressed data cannot be unpacked");
      cursor.skip(packed_sizes[k]);
    }
    return unpacked;
  }

  const pugi::xml_node& node_;
  const VtkStorage& storage_;
  std::string name_;
};

}  // namespace

VtkArray read_vtk_array(const pugi::xml_node& node, const VtkStorage& storage) {
  return ArrayReader(node, storage).read();
}

}  // namespace rhizodont
