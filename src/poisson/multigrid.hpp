// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "poisson/level_fields.hpp"
#include "poisson/spline_level.hpp"

namespace rhizodont {

/// Coefficients on all levels, one level after the other (`SplineLevel::first`). The function they stand for is the sum
/// over all levels; coarse functions may be sums of fine ones, so several fields can stand for the same function.
using LevelField = std::vector<double>;

struct PoissonSolution {
  LevelField coefficients;  ///< zero for functions that are not active
  int cycles = 0;
  /// Euclidean norm, over the active functions of all levels, of load - A coefficients over that of the load, in
  /// double.
  double relative_residual = 0.0;
};

/// How many entries a field on these levels has.
std::size_t field_size(const std::vector<SplineLevel>& levels);

/// The sum over a level and all coarser ones, written in the stored functions of that level.
LevelField accumulated(const std::vector<SplineLevel>& levels, const LevelField& coefficients);

/// Laplacian and screening: for each active function B_i of each level
/// out = int grad B_i . grad u + sum over samples weight B_i(p) u(p), where u is the function that `coefficients` stand
/// for. `samples` come by levels, each on the finest level with an active function that does not vanish there.
/// Results do not depend on the number of threads.
class ScreenedLaplacian {
 public:
  ScreenedLaplacian(const std::vector<SplineLevel>& levels, const std::vector<std::vector<ScreeningSample>>& samples);
  void apply(const LevelField& coefficients, LevelField& out);

 private:
  const std::vector<SplineLevel>& levels_;
  std::vector<BlockSamples<double>> samples_;
  LevelField sums_, outer_;
};

/// Adds to `load`, for each active function of each level, the sum over samples of weight * value * B_i(p). `samples`:
/// as for `ScreenedLaplacian`.
void add_screening_load(const std::vector<SplineLevel>& levels,
                        const std::vector<std::vector<ScreeningSample>>& samples, double value, LevelField& load);

/// Solves for the screened Laplacian = load. Stops at the relative residual `tolerance` or after `max_cycles`; the
/// caller looks at the residual reached.
PoissonSolution solve_screened_poisson(const std::vector<SplineLevel>& levels,
                                       const std::vector<std::vector<ScreeningSample>>& samples, const LevelField& load,
                                       double tolerance, int max_cycles);

}  // namespace rhizodont
