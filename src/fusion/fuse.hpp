// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fusion/join.hpp"
#include "fusion/remesh_root.hpp"
#include "fusion/restore.hpp"
#include "fusion/root_sites.hpp"
#include "fusion/separate.hpp"
#include "fusion/transition.hpp"
#include "teeth/prepared_crown.hpp"

#include <string>
#include <vector>

namespace rhizodont {

struct FuseOptions {
  double edge_growth = 0.9;  ///< > 0: how fast edges grow with the distance from a short border edge
  /// Tried in turn where new triangles have angles below the transition's bounds, until two give the same worst angle
  /// or two in turn make it no better; the best tooth is taken.
  std::vector<double> other_growths{0.75, 0.6, 1.2, 0.5};
  double edge_shrinkage = 0.15;  ///< > 0: how fast they shrink from a long one
  SeparationOptions separation;
  RootSitesOptions sites;
  JoinOptions join;
  RestoreOptions restore;
  RemeshRootOptions remesh;
  TransitionOptions transition;
  int attempts = 2;         ///< >= 1: each starts the root farther from the crown's border than the one before
  int remesh_attempts = 4;  ///< >= 1: each leaves more of the triangles alone where the one before made the tooth cut
                            ///< itself
};

/// Wall-clock seconds that the steps took, all attempts together.
struct FuseSeconds {
  double separation = 0;  ///< with border, distances from the crown and what all attempts share
  double sites = 0;
  double joining = 0;
  double restoring = 0;
  double remeshing = 0;
  double transition = 0;
};

/// A closed tooth made of the crown and the guiding surface's root, with what the steps on the way did: those of the
/// attempt that gave it, and nothing of those before, but for the seconds.
struct FusedTooth {
  JoinedTooth tooth;
  RootRemeshing remeshing;
  Transition transition;
  int root_sites = 0;               ///< root vertices that the dual was taken of
  int crown_triangles_direct = 0;   ///< crown triangles that the dual of the restricted Voronoi diagram gave directly
  int steiner_points = 0;           ///< that made the crown a Delaunay mesh; none is left in the tooth
  int non_delaunay_edges_left = 0;  ///< of the crown in spite of them
  double sharpest_notch = 180;      ///< see CrownBorder::sharpest_notch
  FuseSeconds seconds;
  int sites_without_cell = 0;  ///< sites that the guiding surface does not come near
  std::vector<std::string> warnings;
};

/// Joins crown and guiding surface: separate, choose root vertices, join by the restricted Voronoi diagram, restore the
/// crown, improve the root's triangles and smooth the transition. Every result is tested for self-intersection; a step
/// that would break the tooth is left out and said in the warnings. If no closed tooth comes out, the root is started
/// farther from the crown. `crown` is manifold, one component, its border loops not touching, its triangles not cutting
/// each other; `growth_axis` a unit vector to the crown, the root's own if it leans. Throws NoResultError where no
/// attempt gives a closed tooth.
FusedTooth fuse_crown_and_root(const PreparedCrown& crown, const TriangleMesh& guiding_surface,
                               const Eigen::Vector3d& growth_axis, const FuseOptions& options = {});

}  // namespace rhizodont
