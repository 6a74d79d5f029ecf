// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <span>
#include <vector>

#include "isosurface/goldberg.hpp"
#include "isosurface/index_map.hpp"
#include "isosurface/isosurface.hpp"

namespace rhizodont {

/// The tetrahedra that one component of a surface cuts.
struct CutCells {
  std::vector<LatticeVertex> vertices;             ///< at which the field was evaluated, also of other components
  std::vector<bool> inside;                        ///< per vertex: field > iso
  std::vector<std::array<std::int32_t, 4>> cells;  ///< corners A, B, C, D as indices of `vertices`
  std::size_t other_components = 0;
  std::size_t visited = 0;  ///< cut cells of all components
};

/// Finds the cut cells near the seeds, follows the surface from cell to cell, and keeps the component that most
/// seeds touch. Errors as for `mid_normal`.
/// `labels`: by `GoldbergTiling::key`, vertices that count as inside (1) or outside (0) whatever the field.
CutCells find_cut_cells(const ScalarField& field, double iso, std::span<const Point> seeds,
                        const GoldbergTiling& tiling, const IsosurfaceOptions& options,
                        const IndexMap& labels = IndexMap(1));

}  // namespace rhizodont
