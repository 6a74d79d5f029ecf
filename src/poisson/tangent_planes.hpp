// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "poisson/neighbours.hpp"
#include "rhizodont/mesh.hpp"

namespace rhizodont {

/// The surface near one point, without a side.
struct TangentPlane {
  Eigen::Vector3d normal;    ///< unit, of arbitrary sign
  double reliability = 1.0;  ///< [0, 1]: 1 where the neighbours form a plane, 0 where they fill space or a line
};

/// Planes through each point and its neighbours. Neighbours whose hints point elsewhere count less, and so do those
/// that lie off the plane: they are taken for another sheet. `hints`: unit or zero, one per point.
std::vector<TangentPlane> tangent_planes(std::span<const Point> points, std::span<const Eigen::Vector3d> hints,
                                         const Neighbours& near);

/// The distance over which neighbours of point i count: that of its sixth neighbour.
double neighbour_scale(const Neighbours& near, std::size_t i);

}  // namespace rhizodont
