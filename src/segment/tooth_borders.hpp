// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "segment/teeth_reading.hpp"
#include "segment/tooth_instances.hpp"

#include <vector>

namespace rhizodont {

struct ToothBorderOptions {
  double smoothness = 1;      ///< >= 0: cost of a mm of border on even ground; a mm^2 of wrong surface costs log-odds
  double crease = 2;          ///< >= 0: how much cheaper a border is in a hollow
  double least_share = 0.01;  ///< 0..1: of what a point may become
  int rounds = 2;             ///< >= 1
};

/// Borders between teeth and gum on the scan's own vertices: which tooth each belongs to, -1 for gum. What the points
/// around a vertex say is weighed against the borders' length, which counts less in hollows. Alpha expansion: Y.
/// Boykov, O. Veksler, R. Zabih, "Fast approximate energy minimization via graph cuts", 2001. Triangles must have three
/// different corners in range.
std::vector<int> draw_borders(const TriangleMesh& scan, const TeethReading& reading, const ToothInstances& instances,
                              const ToothBorderOptions& options = {});

/// Gives up all pieces of a tooth but the largest (by edges); they become gum. @param labels  -1 is gum
void keep_largest_pieces(const TriangleMesh& scan, std::vector<int>& labels);

}  // namespace rhizodont
