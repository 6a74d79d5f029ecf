// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "poisson/bspline.hpp"
#include "poisson/spline_grid.hpp"

namespace rhizodont {

/// The Laplace operator of a spline grid, int grad B_i . grad B_j, applied without a matrix as a sum of three tensor
/// products. Results do not depend on the number of threads.
template <class Scalar>
class LaplaceStencil {
 public:
  explicit LaplaceStencil(const SplineGrid& grid);

  /// out = A u on the functions inside the box. Preconditions: both of grid.size(); the halo of u is zero; the halo of
  /// out is left alone.
  void apply(const std::vector<Scalar>& u, std::vector<Scalar>& out);

  /// An upper bound of the largest eigenvalue.
  double largest_eigenvalue() const { return largest_eigenvalue_; }

 private:
  SplineGrid grid_;
  SplineTables tables_;
  double largest_eigenvalue_;
  std::vector<Scalar> mass_mass_;      // mass along x and y
  std::vector<Scalar> stiffness_sum_;  // stiffness along x or y, mass along the other
};

/// coarse = transposed refinement of fine; the halo of `coarse` is left alone. `grid` is the fine one.
template <class Scalar>
void restrict_field(const SplineGrid& grid, const std::vector<Scalar>& fine, std::vector<Scalar>& coarse);

/// fine += refinement of coarse, on the functions inside the box. `grid` is the fine one.
template <class Scalar>
void prolong_add(const SplineGrid& grid, const std::vector<Scalar>& coarse, std::vector<Scalar>& fine);

/// out += scale * (taps_x (x) taps_y (x) taps_z) field: for each function i inside the box the sum over all j of
/// taps[2 + j - i] per axis. The halo of `field` takes part.
void add_tensor_product(const SplineGrid& grid, const std::array<std::array<double, 5>, 3>& taps, double scale,
                        const std::vector<double>& field, std::vector<double>& out);

}  // namespace rhizodont
