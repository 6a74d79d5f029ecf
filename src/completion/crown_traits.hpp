// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "completion/frame.hpp"
#include "rhizodont/mesh.hpp"

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace rhizodont {

/// Numbers that say how a crown and a type's mean crown agree where the one lies on the other. Lengths are in
/// millimetres of the mean crown's size, so that a large tooth is no worse than a small one.
struct CrownTraits {
  /// In this order: logarithms of the two-way trimmed distances (crown to mean, mean to crown; normals included) and of
  /// the plain mean distances (likewise); share of the crown that the mean explains, share of the mean that is seen;
  /// logarithm of the crown's size over the mean's; lean of the mean against the crown's border, radians; logarithms of
  /// the crown's extents over the mean's along x, y, z; height of the crown's lower end over the mean's, mm; logarithms
  /// of the distances that 95 % stay below (likewise).
  static constexpr std::size_t agreement_count = 14;
  /// Points of the mean crown at which the crown's distance is taken along the normal.
  static constexpr std::size_t place_count = 128;

  std::array<float, agreement_count> agreement{};
  std::array<float, place_count> offsets{};  ///< mm, outward; 0 where the crown is not seen
  double distance_mm = 0;                    ///< plain mean distance, both ways, at the crown's own size
  double seen = 0;                           ///< share of the mean crown with crown surface near it, 0..1
  double explained = 0;                      ///< share of the crown's surface with the mean crown near it, 0..1
};

/// One of the 32 teeth, and the traits of a crown with its mean crown.
struct ToothTraits {
  std::size_t tooth = 0;  ///< 2 * type + (right side ? 1 : 0)
  CrownTraits traits;
};

/// The traits of a crown with the teeth whose mean crowns lie nearest (lay_likely_teeth, twelve of them), and with the
/// tooth `also`, which comes first. Deterministic. Throws as canonical_frame.
std::vector<ToothTraits> crown_traits(const TriangleMesh& open_crown, const Atlas& atlas,
                                      std::optional<std::size_t> also = {});

}  // namespace rhizodont
