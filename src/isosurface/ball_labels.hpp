// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "isosurface/cut_cells.hpp"
#include "isosurface/index_map.hpp"

namespace rhizodont {

/// Lattice vertices that are to count as inside or outside whatever the field says there.
struct LabelChanges {
  IndexMap inside;        ///< from `GoldbergTiling::key` to 1 = inside, 0 = outside
  std::size_t count = 0;  ///< of changes that alter the surface kept
  bool cut = false;       ///< bridges were cut; else tunnels were filled
};

/// Changes that make the surface of `cells` a sphere: either bridges are cut where the field is lowest, or tunnels
/// filled where it is highest, whichever strays less from the field.
LabelChanges changes_to_ball(const ScalarField& field, double iso, const CutCells& cells, const GoldbergTiling& tiling,
                             double e);

/// For tests: whether a vertex may change sides without a change of topology, by which of its 14 neighbours (in the
/// order of `lattice_neighbours`) are inside.
bool is_simple(std::uint32_t inside_neighbours);
const std::array<LatticeVertex, 14>& lattice_neighbours();

}  // namespace rhizodont
