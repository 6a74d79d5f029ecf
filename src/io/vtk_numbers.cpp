// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/vtk_numbers.hpp"

#include "io/attribute_types.hpp"
#include "io/cursors.hpp"

#include <cstdint>

namespace rhizodont {
namespace {

template <class Function>
decltype(auto) with_number(VtkNumber type, Function&& function) {
  if (type == VtkNumber::int64) return function(std::int64_t{});
  if (type == VtkNumber::uint64) return function(std::uint64_t{});
  return with_attribute_type(attribute_type(type), function);
}

}  // namespace

AttributeType attribute_type(VtkNumber type) {
  switch (type) {
    case VtkNumber::int8:
      return AttributeType::int8;
    case VtkNumber::uint8:
      return AttributeType::uint8;
    case VtkNumber::int16:
      return AttributeType::int16;
    case VtkNumber::uint16:
      return AttributeType::uint16;
    case VtkNumber::int32:
      return AttributeType::int32;
    case VtkNumber::uint32:
      return AttributeType::uint32;
    case VtkNumber::float32:
      return AttributeType::float32;
    default:
      return AttributeType::float64;
  }
}

std::size_t byte_size(VtkNumber type) {
  return with_number(type, [](auto kind) { return sizeof(kind); });
}

std::vector<double> numbers_from(VtkNumber type, std::string_view bytes, std::endian order) {
  return with_number(type, [&](auto kind) {
    using Number = decltype(kind);
    ByteCursor cursor(bytes, order);
    std::vector<double> values(bytes.size() / sizeof(Number));
    for (double& value : values) value = static_cast<double>(cursor.read<Number>());
    return values;
  });
}

std::optional<double> number_from(VtkNumber type, std::string_view word) {
  if (type != VtkNumber::float32) return parse_number<double>(word);
  const auto value = parse_number<float>(word);
  if (!value) return std::nullopt;
  return static_cast<double>(*value);
}

}  // namespace rhizodont
