// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

#include <vector>

namespace rhizodont {

/// Where the stages have their origin, in the input's coordinates.
struct Workplace {
  Point origin = Point::Zero();  ///< the input's own, unless the crown lies far from it
  double millimetres_per_unit = 1;
  bool as_float = true;  ///< new coordinates are rounded to float, as the input's are
};

/// A crown far from the origin is moved there first, by whole steps of a grid: that rounds no coordinate whose last
/// digit is a part of a step, as all floats' are that lie as far out as the crown; a double or a stray vertex nearer to
/// 0 may lose its last digit, 1e-14 mm. The stages alone work with that: the tooth has the input's own bits. A crown
/// nearby stays, so that its tooth has always the same bits.
Workplace workplace(const TriangleMesh& input, double millimetres_per_unit);

/// The mesh with each vertex moved.
TriangleMesh moved_by(TriangleMesh mesh, const Eigen::Vector3d& move);

/// A tooth from the workplace (mm, the kept crown's vertices first) in the input's coordinates: crown vertices are the
/// input's own bits.
TriangleMesh in_input_coordinates(const TriangleMesh& tooth, const TriangleMesh& input, const std::vector<int>& kept,
                                  const Workplace& place);

}  // namespace rhizodont
