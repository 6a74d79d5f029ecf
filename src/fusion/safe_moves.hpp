// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fusion/restore.hpp"

#include <Eigen/Core>

#include <vector>

namespace rhizodont {

struct SafeMoveOptions {
  double inner_angle = 20;  ///< degrees, [0, 30]: moves take no angle of a new triangle below this,
  double border_angle = 5;  ///< nor below this where the triangle touches the crown
  int cut_rounds = 6;       ///< >= 1: tests for self-intersection, each but the last followed by taking moves back
};

struct SafelyMoved {
  TriangleMesh mesh;
  double applied = 1;        ///< share of the moves that was safe to apply, mean over vertices, 0..1
  bool cuts_itself = false;  ///< the tooth cuts itself, moved or not
};

/// Moves new vertices of a tooth to the targets (mm, one a row). Where a triangle would turn over, lose a good angle or
/// cut another, the vertices about it move less or not at all. Precondition: the crown's own triangles do not cut each
/// other; `vertices` are different, and none of the crown.
SafelyMoved move_safely(const JoinedTooth& tooth, const std::vector<int>& vertices, const Eigen::MatrixXd& targets,
                        const SafeMoveOptions& options = {});

}  // namespace rhizodont
