// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <vector>

#include "poisson/screening.hpp"
#include "poisson/spline_grid.hpp"

namespace rhizodont {

struct PoissonSolution {
  SplineField<double> coefficients;  ///< of grid.size(), zero in the halo
  int cycles = 0;
  double relative_residual = 0.0;  ///< Euclidean norm of load - A coefficients over that of the load, in double
};

/// out = (Laplace + screening) u in double; the halo of `out` is left alone. For tests and residuals.
void apply_screened_laplacian(const SplineGrid& grid, const std::vector<ScreeningSample>& samples,
                              const SplineField<double>& u, SplineField<double>& out);

/// Solves (Laplace + screening) u = load. Stops at the relative residual `tolerance` or after `max_cycles`; the caller
/// looks at the residual reached.
PoissonSolution solve_screened_poisson(const SplineGrid& grid, const std::vector<ScreeningSample>& samples,
                                       const SplineField<double>& load, double tolerance, int max_cycles);

}  // namespace rhizodont
