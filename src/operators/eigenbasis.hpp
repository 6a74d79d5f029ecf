// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "operators/surface_operators.hpp"

namespace rhizodont {

/// The smoothest functions on a surface.
struct Eigenbasis {
  Eigen::VectorXd
      values;  ///< k eigenvalues, ascending, >= 0; the first is 0; about the eigenvalue's number for large k
  Eigen::MatrixXd vectors;  ///< n x k, orthonormal under the mass; the entry of largest magnitude is positive
};

/// The k smallest solutions of stiffness phi = lambda mass phi, to about 1e-6 in the vectors.
/// Lanczos iteration in blocks on the shifted and inverted problem, orthogonalised in full: equal eigenvalues, as on
/// symmetric surfaces, are found as often as they occur (G. Golub, R. Underwood, "The block Lanczos method for
/// computing eigenvalues", 1977; R. Grimes, J. Lewis, H. Simon, 1994). Deterministic. Throws UsageError for k < 1,
/// InputError for k of more than half of the vertices or a mesh too degenerate.
Eigenbasis eigenbasis(const SurfaceOperators& operators, int k);

/// Heat kernel signatures (J. Sun, M. Ovsjanikov, L. Guibas, 2009): how much heat is left at each vertex (n rows) after
/// each time (columns; units of area in which the surface has 4 pi), from the basis' part of the spectrum.
Eigen::MatrixXd heat_kernel_signatures(const Eigenbasis& basis, const Eigen::VectorXd& times);

}  // namespace rhizodont
