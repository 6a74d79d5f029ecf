// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "completion/registration.hpp"
#include "networks/completion_network.hpp"
#include "rhizodont/mesh.hpp"

namespace rhizodont {

/// A whole tooth as the completion network sees it.
struct PredictedTooth {
  OrientedPoints cloud;                   ///< mm, over crown and root, unit normals that point out of the tooth
  std::vector<double> expected_distance;  ///< mm, > 0, per point: how far from its true place it is, on average
};

/// Points of the whole tooth that belongs to a crown, as the completion network sees it (paper, section 3.3); the root
/// longer or shorter by what its weights say of the tooth's type (root_length_correction.hpp).
/// @param crown    open crown, millimetres; any size and density of triangles
/// @param fdi      FDI number; 0 where it is not known
/// @param frame    the crown's canonical frame: the side and pose that the network works in, and the axis of its form
/// @param network  with its weights
/// @return         in the crown's millimetres; the crown's points are the network's too, not the scan's
/// The same for the same crown, whatever the number of threads. Throws InputError for a crown without area or far from
/// a tooth's size, UsageError for an unknown FDI number.
PredictedTooth complete_points(const TriangleMesh& crown, int fdi, const CrownFrame& frame,
                               const CompletionNetwork& network);

}  // namespace rhizodont
