// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/io.hpp"

#include <bit>
#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

// Numbers as both generations of VTK's files store them.
namespace rhizodont {

enum class VtkNumber { int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32, float64 };

/// The type that holds such numbers in a mesh; float64 for int64 and uint64.
AttributeType attribute_type(VtkNumber type);

/// Bytes of one number.
std::size_t byte_size(VtkNumber type);

/// As many numbers as there are bytes for.
std::vector<double> numbers_from(VtkNumber type, std::string_view bytes, std::endian order);

/// A number as text; for float32 the nearest float. Nothing if the word is no number.
std::optional<double> number_from(VtkNumber type, std::string_view word);

}  // namespace rhizodont
