// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/export.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace rhizodont {

/// What a repair did.
enum class RepairAction {
  other,                  ///< of a report alone: one that this version does not know
  same_place_merged,      ///< a vertex became one with another one at its place
  inward_copy_dropped,    ///< of a double-sided triangle
  bad_triangle_dropped,   ///< without area, or there twice
  seam_merged,            ///< vertices on both sides of a seam became one
  t_junction_cut,         ///< a triangle was cut at vertices that lie on its edge
  crowded_edge_dropped,   ///< what met at an edge with more than two triangles
  speck_dropped,          ///< tiny pieces beside the crown
  piece_dropped,          ///< pieces much smaller than the crown
  turned_over,            ///< a triangle that faced the other way
  touching_dropped,       ///< where the surface touches itself
  spike_dropped,          ///< a vertex far from its neighbours
  tunnel_cut,             ///< along its shortest loop
  cutting_dropped,        ///< where the surface cuts itself
  cap_at_border_dropped,  ///< triangles of a cap all of whose vertices are the crown's border's
};

/// One repair of a crown: what was done, and to which vertices and triangles of the input.
struct RepairStep {
  RepairAction action = RepairAction::other;
  std::vector<int> vertices;          ///< that are no longer there, ascending
  std::vector<int> triangles;         ///< that are no longer there as they were although their corners are, ascending
  std::vector<int> merged_into = {};  ///< of a seam: per entry of `vertices` the one that stands in its place
  double widest_seam_mm = 0;          ///< of a seam: the largest distance that was bridged; 0 if read from a report
};

/// What was done, as reports and the screen say it: "vertex merged with another one at the same place".
RHIZODONT_EXPORT std::string action_text(const RepairStep& step);

/// The action that a report's text names; `other` for an unknown one.
RHIZODONT_EXPORT RepairAction action_of_text(std::string_view text);

}  // namespace rhizodont
