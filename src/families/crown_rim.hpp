// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

#include <Eigen/Geometry>

#include <array>
#include <cstddef>
#include <utility>

namespace rhizodont {

/// Where a crown meets the gum, around its own axis: at angle 2 pi i / rim_sectors from x towards y of its frame.
inline constexpr std::size_t rim_sectors = 64;
struct CrownRim {
  std::array<double, rim_sectors> radius{}, height{};  ///< mm, in the crown's frame

  /// Radius and height, linear between sectors. @param angle radians, within [-2 pi, 2 pi]
  std::pair<double, double> at(double angle) const;
};

/// Rim of a crown that is closed by a membrane at the gum, and the frame that goes with it: z from the root to the
/// crown across the rim, y to the cheek, the rim's middle at the origin.
/// @param up      from root to crown, roughly; unit
/// @param buccal  to the cheek, roughly
/// @param frame   of the crown: takes its coordinates to those of the mesh
CrownRim find_rim(const TriangleMesh& crown, const Eigen::Vector3d& up, const Eigen::Vector3d& buccal,
                  Eigen::Isometry3d& frame);

}  // namespace rhizodont
