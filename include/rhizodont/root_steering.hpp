// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

namespace rhizodont {

/// mm: no root that is steered, and no bound of an interval, is shorter or longer, from the crown's lowest point to the
/// apex. Mean roots are 11 to 17 mm long (Wheeler); resorbed roots, and crowns cut low on the root, leave less.
inline constexpr double shortest_root_mm = 3;
inline constexpr double longest_root_mm = 30;

/// What the user knows or wants of a root; the crown stays as it is.
struct RootSteering {
  /// mm, [shortest_root_mm, longest_root_mm]: length along the growth axis from the crown's lowest point to the apex,
  /// as measured on an X-ray.
  std::optional<double> length_mm;
  double tip_degrees = 0;     ///< [-30, 30]: turns the root about its start; positive: apex towards distal
  double torque_degrees = 0;  ///< [-30, 30]: positive: apex towards tongue or palate
  double bend_degrees = 0;    ///< [-45, 45]: bends its lower half; positive: apex towards distal

  bool operator==(const RootSteering&) const = default;

  /// True if there is anything to do.
  bool any() const { return length_mm || tip_degrees != 0 || torque_degrees != 0 || bend_degrees != 0; }
};

}  // namespace rhizodont
