// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"
#include "teeth/crown_border.hpp"

#include <Eigen/Geometry>

#include <cstddef>
#include <vector>

namespace rhizodont {

/// How long edges of the root are to be at a place: as long as the crown's border edges beside the border, from there
/// growing or shrinking with the distance to the length that the root has.
class EdgeLengths {
 public:
  /// `root`: mm, > 0, the length away from the border; `growth` and `shrinkage`, both > 0: change of length per
  /// distance from a border edge that is shorter or longer. Precondition: `border` is that of `crown`.
  EdgeLengths(const TriangleMesh& crown, const CrownBorder& border, double root, double growth, double shrinkage);

  double at(const Point& p) const;
  double root() const { return root_; }

 private:
  struct Source {
    Point middle = Point::Zero();
    double length = 0;  // mm
  };
  /// Sources that follow each other along the border and so lie together.
  struct Group {
    std::size_t begin = 0, end = 0;
    Eigen::AlignedBox3d box;
    double shortest = 0, longest = 0;  // mm
  };
  double root_, growth_, shrinkage_;
  double reach_ = 0;  // mm from the border's box: farther off the root's length holds
  Eigen::AlignedBox3d box_;
  std::vector<Source> sources_;
  std::vector<Group> groups_;
};

}  // namespace rhizodont
