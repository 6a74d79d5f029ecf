// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"
#include "rhizodont/root_steering.hpp"
#include "teeth/frame.hpp"

#include <vector>

namespace rhizodont {

/// Throws UsageError where a wish is out of the range that `RootSteering` states or not a number.
void require_steering_in_range(const RootSteering& steering);

/// Moves the points of a whole tooth so that its root follows the user's wishes; what lies on the crown's side of the
/// lowest point of the crown's border stays where it is, bit for bit, and the root leaves it without a kink.
///
/// The root is bent as a rod is: each level below the crown turns with the centre line, which keeps cross-sections. The
/// length, along the growth axis from the crown's lowest point to the lowest of `points`, is set after that, by
/// stretching depths.
/// @param points  of the tooth's surface, mm, reaching below the crown
/// @param crown   open crown, mm; its border gives level and middle of the root's start
/// @param frame   the crown's canonical frame: growth axis, direction to the cheek
/// @param fdi     FDI number: which way is distal
/// Throws UsageError for wishes out of range and NoResultError for a length that the root cannot be brought to without
/// folding.
void steer_root(std::vector<Point>& points, const TriangleMesh& crown, const CanonicalFrame& frame, int fdi,
                const RootSteering& steering);

}  // namespace rhizodont
