// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "networks/scan_sample.hpp"

#include <cstdint>
#include <functional>
#include <vector>

namespace rhizodont {

/// A scan's points with what they are, in the true frame (z occlusal, y to the front).
struct LabelledCloud {
  ScanCloud cloud;
  std::vector<std::uint8_t> teeth;  ///< per point: FDI number, 0 gum and everything else
  bool upper = false;
};

/// The scan number `index`: the same number always gives the same one. Called from several threads at once.
using CloudProvider = std::function<LabelledCloud(std::uint64_t index)>;

/// Kind 0..scan_kind_count - 1 of an FDI number (milk teeth by their place) in the frame of an upper or a lower jaw,
/// where the patient's right is -x or +x.
inline int scan_kind(int fdi, bool upper) {
  if (fdi == 0) return 0;
  const int quadrant = (fdi / 10 - 1) % 4 + 1;
  const bool right = quadrant == 1 || quadrant == 4;
  return fdi % 10 + (right == upper ? 0 : 8);
}

/// The kind on the other side.
inline int mirrored_kind(int kind) { return kind == 0 ? 0 : kind <= 8 ? kind + 8 : kind - 8; }

}  // namespace rhizodont
