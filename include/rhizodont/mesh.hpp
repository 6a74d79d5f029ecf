// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <vector>

namespace rhizodont {

using Point = Eigen::Vector3d;  ///< a position in millimetres

/// Indices of a triangle's vertices, counterclockwise when seen from outside.
using Triangle = std::array<std::int32_t, 3>;

/// An indexed triangle mesh. Plain data: nothing is promised about it until `diagnose` has looked.
struct TriangleMesh {
  std::vector<Point> vertices;      ///< millimetres
  std::vector<Triangle> triangles;  ///< each index in [0, vertices.size())
};

/// Points with unit normals that point out of the solid.
struct OrientedPoints {
  std::vector<Point> points;             ///< millimetres
  std::vector<Eigen::Vector3d> normals;  ///< unit length, outward; as many as points
};

}  // namespace rhizodont
