// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

#include <optional>
#include <vector>

namespace rhizodont {

struct MadeCapOptions {
  int least_fan = 16;         ///< > 8: triangles about one vertex; scans have up to a dozen
  double long_edge = 2.5;     ///< > 1: times the median edge: edges as long as this run across a base, not along a scan
  double flat_mm = 1e-3;      ///< mm, > 0: how far the corners of a flat base may lie from its plane
  int least_rim = 12;         ///< >= 3: edges around a cap
  double least_share = 0.25;  ///< (0, 1]: cross-section of a cap over that of the whole
  double least_flatness = 0.6;   ///< [0, 1]: |sum of area vectors| / area of a cap but for its walls
  double least_roundness = 0.2;  ///< [0, 1): area of a cap over that of a circle with its rim; the band between the
                                 ///< outer and the inner side of a shell is far below
  double least_crown = 0.3;      ///< [0, 1): area of what is left over that of the whole
};

/// The triangles with which a program closed a crown's base, as far as they betray themselves: a fan about a vertex,
/// triangles between vertices of the border alone, an exactly flat bottom; with the regular rows of walls between them
/// and the crown, as of a plinth. No scan and no remeshed cap has such triangles. True per triangle of the cap, of
/// which no crown triangle is one; where a border is ragged, triangles that fill a notch in the crown's own surface may
/// be missing. Nothing where no sign of such a cap is found.
/// Precondition: closed, manifold, consistently oriented.
std::optional<std::vector<bool>> find_made_cap(const TriangleMesh& closed_crown, const MadeCapOptions& options = {});

}  // namespace rhizodont
