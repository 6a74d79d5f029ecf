// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Cholesky>

#include <memory>
#include <vector>

#include "poisson/level_fields.hpp"
#include "poisson/spline_level.hpp"

namespace rhizodont {

/// One symmetric multigrid cycle for the screened Laplacian on nested levels, in single precision: smoothing from the
/// finest level to the coarsest, which is solved exactly, and back.
class LevelCycle {
 public:
  /// `samples`: as for `ScreenedLaplacian`.
  LevelCycle(const std::vector<SplineLevel>& levels, const std::vector<std::vector<ScreeningSample>>& samples);

  /// x = about A^-1 r. Both span all levels; r is zero where functions are not active.
  void apply(const std::vector<float>& r, std::vector<float>& x);

 private:
  struct Level {
    const SplineLevel* spline = nullptr;
    BlockSamples<float> samples;
    std::vector<float> inverse_bound;  // zero for functions that are not active
    std::vector<float> load;           // what is left of r by finer levels
    std::vector<float> residual, direction, next_direction;
    std::vector<float> outer;  // what the level's and finer corrections contribute to the left side, also beyond the
                               // active functions
    std::vector<float> sum;    // of this level's and coarser corrections
  };

  /// Calls visit(block, A u on the block) for all blocks.
  template <class Visit>
  void for_each_product(const Level& level, const float* u, const Visit& visit) const;
  /// Adds to x about A^-1 residual, x in the level's own functions.
  void smooth(Level& level, float* x);
  void restrict_load(std::size_t l, const float* r);
  void find_inverse_bound(Level& level, const std::vector<ScreeningSample>& samples);
  void factorise_coarsest();
  void solve_coarsest(float* x);

  std::vector<Level> levels_;
  std::vector<std::size_t> coarsest_functions_;
  Eigen::LLT<Eigen::MatrixXd> coarsest_;
};

}  // namespace rhizodont
