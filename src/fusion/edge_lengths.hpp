// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fusion/crown_border.hpp"
#include "rhizodont/mesh.hpp"

#include <vector>

namespace rhizodont {

/// How long edges of the root are to be at a place: as long as the crown's border edges beside the border, from there
/// growing or shrinking with the distance to the length that the root has.
struct EdgeLengths {
  struct Source {
    Point middle = Point::Zero();
    double length = 0;  ///< mm
  };
  double root = 0.27;           ///< mm, > 0: away from the border
  double growth = 0.5;          ///< > 0: per distance from a short border edge; steep, since they are short by accident
  double shrinkage = 0.15;      ///< > 0: per distance from a long border edge
  std::vector<Source> sources;  ///< the border's edges

  double at(const Point& p) const;
};

/// Precondition: `border` is that of `crown`.
EdgeLengths edge_lengths(const TriangleMesh& crown, const CrownBorder& border, double root_edge);

}  // namespace rhizodont
