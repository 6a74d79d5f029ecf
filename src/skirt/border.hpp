// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

#include <vector>

namespace rhizodont {

/// The border of an open crown, whose pieces may touch.
struct CrownBorder {
  std::vector<int> all;    ///< vertices of border edges, ascending
  std::vector<int> outer;  ///< those of the longest connected part, ascending; the others are holes of the scan
};

/// Both are empty for a closed mesh.
CrownBorder crown_border(const TriangleMesh& mesh);

}  // namespace rhizodont
