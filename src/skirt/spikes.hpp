// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

#include <vector>

namespace rhizodont {

struct SpikeOptions {
  /// degrees, [0, 360]: an inner vertex whose corners add up to less is the tip of a spike. 180 is the tip of a cone
  /// of 60.
  double tip = 180;
  double flap = 60;  ///< degrees, [0, 180]: the same for a vertex of the border, whose triangles then stick out of it
  /// degrees, (0, 180]: a vertex of the border that a sharper edge leads to, bent outwards or folded inwards, is the
  /// end of a fin.
  double fin = 95;
  int rounds = 3;  ///< >= 1: a flap is often two or three triangles long; what is left at its tip is judged anew
};

/// Per triangle whether it stays once the tips of spikes, of flaps and of fins are taken off: thin things of a few
/// triangles that a scan shows where the camera saw past the tooth, too small for a network that looks at the surface
/// at large. Hardly a vertex of the clean crowns that the project knows is so pointed, cusps and cut borders included
/// (docs/skirt.md). A vertex of no triangle does not matter. Throws UsageError for options out of range.
std::vector<bool> triangles_without_spikes(const TriangleMesh& crown, const SpikeOptions& options = {});

}  // namespace rhizodont
