// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

#include <vector>

namespace rhizodont {

/// Numbers of a mesh's elements in another order.
struct MeshOrder {
  std::vector<int> vertices, triangles;
};

/// mm: finer than the distances between a scan's vertices.
inline constexpr double space_order_step_mm = 1e-3;

/// Numbers of points along a curve that fills space, whatever order they are in: points next to each other on it lie
/// beside each other, so that where rounding swaps two they are neighbours. Points at one place keep their order;
/// non-finite ones come last. @param step  > 0, in the points' unit: side of the finest cells, 2^20 of which fit on
/// either side of the origin
std::vector<int> space_order(const std::vector<Point>& points, double step);

/// Vertices, and triangles by their middles, in `space_order`.
MeshOrder space_order(const TriangleMesh& mesh, double step);

/// The mesh with its elements so ordered, each triangle beginning with the first of its vertices.
TriangleMesh reordered(const TriangleMesh& mesh, const MeshOrder& order);

}  // namespace rhizodont
