// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/io.hpp"

#include <cstddef>
#include <cstdint>
#include <utility>

namespace rhizodont {

/// Calls `function` with a value of the C++ type that stands for `type`.
template <class Function>
decltype(auto) with_attribute_type(AttributeType type, Function&& function) {
  switch (type) {
    case AttributeType::int8:
      return function(std::int8_t{});
    case AttributeType::uint8:
      return function(std::uint8_t{});
    case AttributeType::int16:
      return function(std::int16_t{});
    case AttributeType::uint16:
      return function(std::uint16_t{});
    case AttributeType::int32:
      return function(std::int32_t{});
    case AttributeType::uint32:
      return function(std::uint32_t{});
    case AttributeType::float32:
      return function(float{});
    case AttributeType::float64:
      break;
  }
  return function(double{});
}

inline std::size_t byte_size(AttributeType type) {
  return with_attribute_type(type, [](auto value) { return sizeof(value); });
}

}  // namespace rhizodont
