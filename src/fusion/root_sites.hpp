// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fusion/edge_lengths.hpp"
#include "fusion/surface_walk.hpp"
#include "rhizodont/mesh.hpp"
#include "teeth/crown_border.hpp"

#include <vector>

namespace rhizodont {

/// Lengths are relative to the edge length wanted at the place.
struct RootSitesOptions {
  double spacing = 0.65;      ///< (0.5, 1): no site is nearer to another
  double reach = 1.25;        ///< > 1: sites up to this far apart propose the third corner of their triangle
  double spring_reach = 1.3;  ///< > 1: sites up to this far push or pull a proposed one
  double stiffness = 1.25;    ///< (0, 2): share of their mean push that it follows
  int spring_steps = 3;       ///< >= 0
};

/// Throws UsageError for an option out of its range.
void require_in_range(const RootSitesOptions& options);

/// Chooses the root's vertices on the guiding surface so that they lie like the points of an equilateral lattice. The
/// front starts at the crown's border with the ideal apex of each border edge and advances row by row: neighbouring
/// sites propose the third corner of an equilateral triangle, the sites about it shift it until it lies at the wanted
/// distance from all of them, and it is taken if there is room. Rows close around a root without a seam, so that few
/// vertices will have other than six neighbours.
///
/// `is_root`: per vertex of the guiding surface, as `separate_crown_and_root` finds it. No site lies nearer to a crown
/// vertex than the spacing. Parts of the root that the front does not reach start fronts of their own.
std::vector<Point> root_sites(const SurfaceWalk& walk, const std::vector<bool>& is_root, const TriangleMesh& crown,
                              const CrownBorder& border, const EdgeLengths& lengths,
                              const RootSitesOptions& options = {});

}  // namespace rhizodont
