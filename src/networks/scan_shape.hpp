// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <map>
#include <string>

namespace rhizodont {

/// Sizes of the network that finds teeth in a scan. The defaults are those of the shipped weights.
struct ScanShape {
  static constexpr int levels = 4;
  std::array<int, levels> widths{32, 64, 128, 192};  ///< channels, finest level first, 8..1024, multiples of 8
  std::array<int, levels> blocks{2, 2, 2, 2};        ///< edge convolutions before going up again, 0..16
  std::array<int, levels> spacings_um{1100, 2200, 4400, 8800};  ///< of the points, micrometres, growing, 200..50000
  int neighbours = 16;                                          ///< that a point looks at, 4..64
  int heads = 4;  ///< of the coarsest level's attention, divides its width
};

/// Sizes in a file's metadata.
void note_scan_shape(const ScanShape& shape, std::map<std::string, std::string>& metadata);
/// Throws InputError if they are missing or out of range.
ScanShape read_scan_shape(const std::map<std::string, std::string>& metadata);
/// Throws UsageError if a size is out of range.
void check_scan_shape(const ScanShape& shape);

}  // namespace rhizodont
