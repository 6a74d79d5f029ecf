// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

#include <Eigen/SparseCore>

namespace rhizodont {

/// Differential operators at the vertices of a mesh, in units in which its area is 4 pi (that of the unit sphere): the
/// same for a mesh of any size. Borders have no flux through them (natural boundary conditions).
struct SurfaceOperators {
  double unit = 1;       ///< mm per unit of length: sqrt(area / (4 pi))
  Eigen::VectorXd mass;  ///< area of each vertex, > 0; a third of the triangles around it, sum 4 pi
  Eigen::SparseMatrix<double>
      stiffness;              ///< symmetric, positive semi-definite, rows sum to 0: mass^-1 stiffness = -Laplace
  Eigen::MatrixX3d normals;   ///< n x 3, unit, outward
  Eigen::MatrixX3d tangents;  ///< n x 3, unit, first axis of each vertex's tangent plane; the second one is
                              ///< normal x tangent
  /// Gradient of a function given at the vertices along the two axes of the tangent planes, per unit of length.
  Eigen::SparseMatrix<double, Eigen::RowMajor> gradient_x, gradient_y;
};

/// Cotangent Laplacian on the intrinsic Delaunay triangulation, lumped mass, and gradients fitted by least squares to
/// the differences along the edges at a vertex (N. Sharp et al., "DiffusionNet", 2022, section 3.3).
/// Triangles without area and needles do no harm. Edges may have more than two triangles.
/// Throws InputError for a mesh without triangles or area, with a coordinate that is not finite or an index out of
/// range, with vertices that no triangle uses, or of several pieces (ids of vertices).
SurfaceOperators surface_operators(const TriangleMesh& mesh);

/// Values at the vertices (n x m) after one implicit step of heat diffusion over time `time` (units of area, >= 0):
/// solves (mass + time stiffness) y = mass x. An eigenfunction of eigenvalue l shrinks by 1 / (1 + time l).
Eigen::MatrixXd diffused(const SurfaceOperators& operators, const Eigen::MatrixXd& values, double time);

/// Vertices and triangles of a mesh in units of length of its operators.
Eigen::MatrixX3d positions_in_units(const TriangleMesh& mesh, const SurfaceOperators& operators);

}  // namespace rhizodont
