// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include <span>

#include "rhizodont/mesh.hpp"

namespace rhizodont {

/// How `orient_normals` works. The defaults are the product's.
struct OrientationOptions {
  int neighbours = 14;        ///< [4, 100]: nearest points from which a tangent plane is estimated
  double hint_trust = 0.2;    ///< [0, 1]: pull of one point's hint on its own sign, against the pull of one neighbour
  double blend = 1.0;         ///< [0, 1]: how far a hint replaces the direction of an unreliable tangent plane
  bool check_outward = true;  ///< turn a separate part as a whole where its normals point into the solid
};

/// Unit outward normals for the points of a closed surface. The direction comes from the principal axes of the
/// neighbours on the same sheet, blended with the hint where these do not form a plane; the sign comes from a linear
/// solve over the neighbour graph in which hints pull and neighbours with parallel tangent planes agree, so that
/// scattered wrong hints are outvoted; at last each separate part is turned such that the flux of its normals is
/// outward.
///
/// \param points  mm, at least 4
/// \param hints   approximate outward normals, one per point, of any length; zero = no hint. Empty = no hints at all
/// \returns the points as given, with unit normals
/// \throws InputError  fewer than 4 points, or non-finite points or hints (ids = points), or a number of hints that is
///                     neither 0 nor that of the points
/// \throws UsageError  an option out of its range
OrientedPoints orient_normals(std::span<const Point> points, std::span<const Eigen::Vector3d> hints = {},
                              const OrientationOptions& options = {});

}  // namespace rhizodont
