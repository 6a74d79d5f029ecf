// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "mesh/seams.hpp"
#include "rhizodont/mesh.hpp"
#include "rhizodont/repair_step.hpp"

#include <vector>

namespace rhizodont {

struct RepairOptions {
  SeamOptions seam;               ///< what is merged although it is not at one place
  double spike_height = 2.5;      ///< > 0: a vertex farther from its neighbours' mean than this many times their mean
                                  ///< distance from that mean is a spike
  double spike_least_mm = 0.3;    ///< mm, >= 0: lower ones are left
  double most_cut_share = 0.05;   ///< [0, 1]: where more vertices than this share are at cuts of the surface with
                                  ///< itself, they are left, for then no crown would be left either
  bool connections_only = false;  ///< only how triangles hang together is mended, so that the mesh can be walked over;
                                  ///< what the surface's form betrays is left: touching vertices, spikes, tunnels, cuts
  int rounds = 16;  ///< >= 1: how often the steps are repeated, since one may lay bare the next defect; one
                    ///< tunnel is cut in each
};

/// What is left of a mesh when its defects are taken out. No coordinate is changed: vertices are dropped or merged with
/// one at the same place or across a seam, triangles are dropped, turned over or cut in two at a vertex that lies on
/// their edge.
struct RepairedMesh {
  TriangleMesh mesh;               ///< without unreferenced vertices
  std::vector<int> old_vertices;   ///< index in the input per vertex, ascending
  std::vector<int> old_triangles;  ///< per triangle the input's that it is or is part of
  std::vector<RepairStep> steps;   ///< in the order in which they were done; none for a mesh without defects
};

/// Repairs, in this order and again until nothing changes: vertices at one place become one; triangles with a repeated
/// vertex, without area or standing twice go, of those standing once each way the inward ones; vertices on both sides
/// of a seam become one; T-junctions are closed by cutting the triangle on the other side; of triangles crowding at an
/// edge those of the smaller patches go, or all where it is one patch; specks and pieces much smaller than the largest
/// go; all triangles are turned as most of their piece's area is; vertices where the surface touches itself, spikes,
/// those along the shortest loop of a tunnel, and those of triangles that cut others go, with all their triangles.
/// The holes that this leaves, and others inside the crown, are left to the joining, which closes them.
///
/// Works on any soup with valid indices. Deterministic. Throws InputError if an index is out of range, a coordinate is
/// not finite, nothing is left, or there are pieces of like size: which of them is the crown, nobody but the user
/// knows.
RepairedMesh repair(const TriangleMesh& mesh, const RepairOptions& options = {});

}  // namespace rhizodont
