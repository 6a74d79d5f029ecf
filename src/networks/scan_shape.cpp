// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "networks/scan_shape.hpp"

#include "rhizodont/error.hpp"

#include <charconv>

namespace rhizodont {
namespace {

const std::string scan_format = "rhizodont scan 1";

using PerLevel = std::array<int, ScanShape::levels>;
constexpr std::array<std::pair<const char*, PerLevel ScanShape::*>, 3> level_sizes{{
    {"width", &ScanShape::widths},
    {"blocks", &ScanShape::blocks},
    {"spacing_um", &ScanShape::spacings_um},
}};
constexpr std::array<std::pair<const char*, int ScanShape::*>, 2> scan_sizes{{
    {"neighbours", &ScanShape::neighbours},
    {"heads", &ScanShape::heads},
}};

std::string level_key(const char* name, std::size_t level) {
  return "shape." + std::string(name) + "." + std::to_string(level);
}

int number_in(const std::map<std::string, std::string>& metadata, const std::string& key) {
  const auto found = metadata.find(key);
  int number = 0;
  if (found != metadata.end()) {
    const std::string& text = found->second;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (failure == std::errc() && end == text.data() + text.size() && !text.empty()) return number;
  }
  throw InputError("The weight file does not say how large the network is (" + key + ").");
}

}  // namespace

void note_scan_shape(const ScanShape& shape, std::map<std::string, std::string>& metadata) {
  metadata["format"] = scan_format;
  for (const auto& [name, member] : level_sizes)
    for (std::size_t level = 0; level < ScanShape::levels; ++level)
      metadata[level_key(name, level)] = std::to_string((shape.*member)[level]);
  for (const auto& [name, member] : scan_sizes) metadata["shape." + std::string(name)] = std::to_string(shape.*member);
}

ScanShape read_scan_shape(const std::map<std::string, std::string>& metadata) {
  const auto format = metadata.find("format");
  if (format == metadata.end() || format->second != scan_format)
    throw InputError("This file does not hold weights of a network that finds teeth in scans.");
  ScanShape shape;
  for (const auto& [name, member] : level_sizes)
    for (std::size_t level = 0; level < ScanShape::levels; ++level)
      (shape.*member)[level] = number_in(metadata, level_key(name, level));
  for (const auto& [name, member] : scan_sizes) shape.*member = number_in(metadata, "shape." + std::string(name));
  try {
    check_scan_shape(shape);
  } catch (const UsageError& error) {
    throw InputError(error.what());
  }
  return shape;
}

void check_scan_shape(const ScanShape& shape) {
  bool good =
      shape.neighbours >= 4 && shape.neighbours <= 64 && shape.heads >= 1 && shape.widths.back() % shape.heads == 0;
  for (std::size_t level = 0; level < ScanShape::levels; ++level) {
    good = good && shape.widths[level] >= 8 && shape.widths[level] <= 1024 && shape.widths[level] % 8 == 0 &&
           shape.blocks[level] >= 0 && shape.blocks[level] <= 16 && shape.spacings_um[level] >= 200 &&
           shape.spacings_um[level] <= 50'000;
    if (level > 0) good = good && shape.spacings_um[level] > shape.spacings_um[level - 1];
  }
  if (!good) throw UsageError("A size of the network that finds teeth in scans is out of range.");
}

}  // namespace rhizodont
