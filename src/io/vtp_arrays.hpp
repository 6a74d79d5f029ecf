// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/io.hpp"

#include <pugixml.hpp>

#include <bit>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace rhizodont {

enum class VtkCompression { none, zlib, lz4 };

/// How the arrays of one VTK XML file are stored.
struct VtkStorage {
  std::endian byte_order = std::endian::little;
  bool wide_header = false;                           ///< sizes before the data are 64 bits, not 32
  VtkCompression compression = VtkCompression::none;  ///< of blocks
  bool appended_raw = false;                          ///< the appended section holds bytes, not base64
  std::string_view appended;                          ///< the appended section, after its underscore
  /// Bytes that arrays may still be unpacked to: any number of them may name the same few bytes.
  std::size_t room = 0;
};

/// Numbers of a DataArray element.
struct VtkArray {
  AttributeType type = AttributeType::float64;  ///< int64 and uint64 are given as float64
  std::size_t components = 1;
  std::vector<double> values;
};

/// Takes what it unpacks from the storage's room. Throws InputError, naming the array, if it is damaged, stored in a
/// way that is not read, or larger than the room.
VtkArray read_vtk_array(const pugi::xml_node& node, VtkStorage& storage);

}  // namespace rhizodont
