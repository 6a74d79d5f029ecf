// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/random_stream.hpp"
#include "learning/train_scan.hpp"
#include "networks/labelled_cloud.hpp"

namespace rhizodont {

/// A scan as it is shown to the network once, with what it should say of it.
struct ShownScan {
  ScanPyramid pyramid;
  std::vector<std::int64_t> kinds;  ///< per point of the finest level
  std::vector<float> middles;       ///< 3 per point: way to the middle of its tooth over scan_offset_mm, zero for gum
  std::vector<float> borders;       ///< 1 where another tooth or gum is within scan_border_mm
  bool upper = false;
  std::array<float, 3> front{}, occlusal{};
};

/// The scan mirrored, cropped, bent, turned and disturbed at random. Depends on its arguments alone.
ShownScan varied(const LabelledCloud& scan, const ScanShape& shape, const ScanVariation& variation,
                 RandomStream& random);

}  // namespace rhizodont
