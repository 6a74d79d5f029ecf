// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace rhizodont {

/// Panoramas with what they show: `channels` maps of rows x columns each (distance, hit, normal along the ray, along
/// the columns, along the rows; 0 where nothing is hit), columns wrapping around.
struct LabelledPanoramas {
  std::size_t channels = 5, rows = 24, columns = 64;
  std::vector<float> values;         ///< panorama by panorama, channel by channel, row by row
  std::vector<std::int32_t> labels;  ///< one per panorama: pairs 2k, 2k + 1 are mirror images; the last is its own
};

/// Panoramas of left teeth with how their crowns stand; labels are types, 0..15.
struct PosedPanoramas {
  LabelledPanoramas panoramas;
  std::vector<float> azimuths;  ///< radians, one per panorama: towards the cheek
  std::vector<float> leans;     ///< two per panorama: the form's axis (unit) along azimuths 0 and 90 degrees
};

}  // namespace rhizodont
