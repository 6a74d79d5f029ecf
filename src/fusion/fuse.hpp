// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fusion/join.hpp"
#include "fusion/remesh_band.hpp"
#include "fusion/restore.hpp"
#include "fusion/separate.hpp"
#include "fusion/transition.hpp"

#include <string>
#include <vector>

namespace rhizodont {

struct FuseOptions {
  SeparationOptions separation;
  JoinOptions join;
  RestoreOptions restore;
  RemeshBandOptions remesh;
  TransitionOptions transition;
  int attempts = 4;  ///< >= 1: each starts the root farther from the crown's border than the one before
};

/// A closed tooth made of the crown and the guiding surface's root, with what the steps on the way did.
struct FusedTooth {
  RestoredTooth tooth;
  Separation separation;
  Transition transition;
  int crown_triangles_direct = 0;  ///< crown triangles that the dual of the restricted Voronoi diagram gave directly
  int steiner_points = 0;          ///< that made the crown a Delaunay mesh; none is left in the tooth
  std::vector<std::string> warnings;
};

/// Joins crown and guiding surface: separate, join by the restricted Voronoi diagram, restore the crown, remesh and
/// smooth the transition. Every step's result is tested for self-intersection; a step that would break the tooth is
/// left out and said in the warnings. If no closed tooth comes out, the root is started farther from the crown. `crown`
/// is open, manifold, one component, its border loops not touching; `growth_axis` a unit vector to the crown. Throws
/// NoResultError where no attempt gives a closed tooth.
FusedTooth fuse_crown_and_root(const TriangleMesh& crown, const TriangleMesh& guiding_surface,
                               const Eigen::Vector3d& growth_axis, const FuseOptions& options = {});

}  // namespace rhizodont
