// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

#include <cstddef>
#include <vector>

namespace rhizodont {

/// A crown as it is seen from inside: what rays from amid its base meet last, by elevation above the plane across the
/// growth axis and by direction around it. Turning the crown about its axis shifts the columns, mirroring it reverses
/// them; where a number is missing the crown is open there.
struct CrownPanorama {
  static constexpr std::size_t rows = 24;          ///< elevations from lowest_elevation to 90 degrees, upwards
  static constexpr std::size_t columns = 64;       ///< directions around the axis, 0 to 360 degrees, counter-clockwise
  static constexpr std::size_t channels = 5;       ///< distance, hit, normal outwards, along the columns, upwards
  static constexpr double lowest_elevation = -20;  ///< degrees

  /// Channel by channel, row by row. Distances in units of 5 mm; hit 1 or 0; the normal's components along the ray, in
  /// the direction of rising azimuth and of rising elevation. All 0 where no surface is met.
  std::vector<float> values;
};

/// Looks at a crown. @param axis unit, from root to crown @param centre mm, amid the base
/// Precondition: finite vertices, valid indices.
CrownPanorama crown_panorama(const TriangleMesh& crown, const Eigen::Vector3d& axis, const Point& centre);

/// World directions to those of a panorama: x towards azimuth 0, y towards 90 degrees, z along the axis (unit).
Eigen::Matrix3d panorama_view(const Eigen::Vector3d& axis);

/// Where a crown is looked at from: on the line along the axis through its area's centroid, at its border's mean
/// height. Throws InputError for a mesh without area or without a border.
Point panorama_centre(const TriangleMesh& open_crown, const Eigen::Vector3d& axis);

}  // namespace rhizodont
