// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

#include <vector>

namespace rhizodont {

/// A triangulation known by its edges' lengths alone. Half-edge h = 3 t + i runs from corner i of triangle t to corner
/// (i + 1) % 3. Two corners of a triangle may be one vertex, and two triangles may share more than one edge.
struct IntrinsicTriangulation {
  std::vector<Triangle> triangles;
  std::vector<double> lengths;  ///< per half-edge, > 0
};

/// The intrinsic Delaunay triangulation of a mesh whose edges were all lengthened by the least amount that gives every
/// triangle, also one without area, a height: triangle inequalities then hold by `margin` mean edge lengths.
/// Cotangent weights on it are not negative at edges with two triangles. Edges with more than two triangles, or with
/// two that are turned against each other, stay as they are.
/// Source: N. Sharp, K. Crane, "A Laplacian for Nonmanifold Triangle Meshes", 2020 (intrinsic mollification); M. Fisher
/// et al., "An algorithm for the construction of intrinsic Delaunay triangulations", 2007.
IntrinsicTriangulation intrinsic_delaunay(const TriangleMesh& mesh, double margin = 1e-5);

/// Area of an intrinsic triangle, >= 0.
double intrinsic_area(const IntrinsicTriangulation& triangulation, std::size_t triangle);

/// Cotangent of the angle opposite of half-edge `half_edge`.
double opposite_cotangent(const IntrinsicTriangulation& triangulation, std::size_t half_edge);

}  // namespace rhizodont
