// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

#include <vector>

namespace rhizodont {

struct SkirtBorderOptions {
  double threshold = 0.5;   ///< (0, 1): confidence from which a vertex alone counts as tooth
  double smoothness = 0.2;  ///< mm, >= 0: what a millimetre of border costs, beside mm^2 of surface on the wrong side
  double crease = 15;       ///< degrees, > 0: across edges bent inwards by more than this the border costs little
  double least_kept = 0.3;  ///< [0, 1]: share of the area; where less would be kept, the crown is refused
};

/// Divides a crown into tooth and skirt as a technician would: near the network's confidence (per vertex, 0..1, "is
/// tooth"), with a short border that runs in the crease where the gum begins (minimum cut on the vertex graph), and the
/// tooth in one piece: islands of skirt inside the tooth are given back to it, islands of tooth in the skirt are not
/// kept, and no handle is left as far as a stricter threshold takes it off. Holes in the tooth's own surface stay.
/// Returns per triangle whether it is kept: those whose three vertices are tooth. All are, where all vertices are
/// tooth. Throws UsageError for bad options or another number of confidences, InputError where hardly anything is
/// tooth. Source: S. Katz, A. Tal, 2003 (cuts in creases); Y. Boykov, V. Kolmogorov, 2004.
std::vector<bool> tooth_triangles(const TriangleMesh& crown, const std::vector<float>& confidence,
                                  const SkirtBorderOptions& options = {});

}  // namespace rhizodont
