// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Multigrid on locally refined levels: each level corrects in its own active functions, and what it leaves over is seen
// by coarser levels through the transposed refinement (fast adaptive composite grids, McCormick 1989; subspace
// correction, Xu 1992). The smoother is a Chebyshev polynomial (Adams, Brezina, Hu, Tuminaro 2003) over a diagonal that
// bounds the operator: the Laplacian's largest eigenvalue plus the screening's row sums, so that no eigenvalue has to
// be estimated.
#include "poisson/level_cycle.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/parallel_tasks.hpp"
#include "poisson/bspline.hpp"

namespace rhizodont {
namespace {

constexpr int smoothing_degree = 3;
constexpr double smoothed_part = 1.0 / 20.0;  // of the spectrum's top: what lies below is left to the coarser level

/// The largest value over all frequencies of the symbol of the infinite Toeplitz operator, which bounds the eigenvalues
/// of every finite section; from a grid of frequencies, with a little to spare.
double largest_symbol(const SplineTables& tables) {
  constexpr int steps = 32;
  std::array<double, steps + 1> mass{}, stiffness{};
  for (std::size_t i = 0; i <= steps; ++i) {
    const double angle = std::numbers::pi * static_cast<double>(i) / steps;
    mass[i] = tables.mass[2] + 2.0 * (tables.mass[3] * std::cos(angle) + tables.mass[4] * std::cos(2.0 * angle));
    stiffness[i] = tables.stiffness[2] +
                   2.0 * (tables.stiffness[3] * std::cos(angle) + tables.stiffness[4] * std::cos(2.0 * angle));
  }
  double largest = 0.0;
  for (std::size_t x = 0; x <= steps; ++x)
    for (std::size_t y = 0; y <= x; ++y)
      for (std::size_t z = 0; z <= y; ++z)
        largest = std::max(largest, stiffness[x] * mass[y] * mass[z] + mass[x] * stiffness[y] * mass[z] +
                                        mass[x] * mass[y] * stiffness[z]);
  return 1.02 * largest;
}

SymmetricTaps<float> taps(const std::array<double, 5>& table, double scale) {
  return {static_cast<float>(scale * table[2]), static_cast<float>(scale * table[3]),
          static_cast<float>(scale * table[4])};
}

template <class Body>
void for_each_block(const SplineLevel& level, const Body& body) {
  tbb::parallel_for(std::size_t{0}, level.blocks.size(), [&](std::size_t b) { body(b, b * SplineLevel::block); });
}

}  // namespace

LevelCycle::LevelCycle(const std::vector<SplineLevel>& levels,
                       const std::vector<std::vector<ScreeningSample>>& samples) {
  levels_.resize(levels.size());
  // A coarser level sees the samples of all finer ones too, one per cell.
  std::vector<std::vector<ScreeningSample>> seen = samples;
  for (std::size_t l = levels.size() - 1; l-- > 0;) {
    seen[l].insert(seen[l].end(), seen[l + 1].begin(), seen[l + 1].end());
    seen[l] = merge_samples(levels[l], seen[l]);
  }
  parallel_tasks(levels.size(), [&](std::size_t l) {
    Level& level = levels_[l];
    level.spline = &levels[l];
    level.samples = BlockSamples<float>(levels[l], seen[l]);
    find_inverse_bound(level, seen[l]);
    for (auto* field :
         {&level.load, &level.residual, &level.direction, &level.next_direction, &level.outer, &level.sum})
      field->assign(levels[l].size(), 0.0F);
  });
  factorise_coarsest();
}

void LevelCycle::find_inverse_bound(Level& level, const std::vector<ScreeningSample>& samples) {
  const SplineLevel& spline = *level.spline;
  std::vector<double> row_sums(spline.size(), 0.0);
  for (const ScreeningSample& sample : samples)
    for_each_function(spline, sample.position,
                      [&](std::size_t f, double value) { row_sums[f] += sample.weight * value; });
  const double bound = spline.spacing * largest_symbol(spline_tables(spline.degree));
  level.inverse_bound.resize(spline.size());
  for (std::size_t i = 0; i < row_sums.size(); ++i)
    level.inverse_bound[i] = spline.active[i] ? static_cast<float>(1.0 / (bound + row_sums[i])) : 0.0F;
}

template <class Visit>
void LevelCycle::for_each_product(const Level& level, const float* u, const Visit& visit) const {
  const SplineLevel& spline = *level.spline;
  const SplineTables tables = spline_tables(spline.degree);
  const auto mass = taps(tables.mass, 1.0), stiffness = taps(tables.stiffness, 1.0);
  const auto h = static_cast<float>(spline.spacing);
  for_each_block(spline, [&](std::size_t b, std::size_t) {
    std::array<float, largest_patch> patch, scratch;
    std::array<float, SplineLevel::block> product;
    gather_patch(spline, u, b, patch.data());
    block_stiffness(spline.degree, mass, stiffness, patch.data(), product.data());
    for (float& p : product) p *= h;
    add_screening<float>(spline, level.samples.of(b), patch.data(), scratch.data(), product.data());
    visit(b, product.data());
  });
}

void LevelCycle::smooth(Level& level, float* x) {
  const double middle = 0.5 * (1.0 + smoothed_part), half = 0.5 * (1.0 - smoothed_part), ratio = middle / half;
  const auto first = static_cast<float>(1.0 / middle);
  for_each_block(*level.spline, [&](std::size_t, std::size_t begin) {
    for (std::size_t i = begin; i < begin + SplineLevel::block; ++i) {
      level.direction[i] = first * level.inverse_bound[i] * level.residual[i];
      x[i] += level.direction[i];
    }
  });
  double rho = 1.0 / ratio;
  for (int k = 1; k < smoothing_degree; ++k) {
    const double next = 1.0 / (2.0 * ratio - rho);
    const auto keep = static_cast<float>(next * rho), step = static_cast<float>(2.0 * next / half);
    for_each_product(level, level.direction.data(), [&](std::size_t b, const float* product) {
      const std::size_t begin = b * SplineLevel::block;
      chebyshev_step(keep, step, level.inverse_bound.data() + begin, product, level.direction.data() + begin,
                     level.residual.data() + begin, level.next_direction.data() + begin, x + begin);
    });
    std::swap(level.direction, level.next_direction);
    rho = next;
  }
}

/// load = r less what finer corrections already make of it.
void LevelCycle::restrict_load(std::size_t l, const float* r) {
  Level& level = levels_[l];
  const SplineLevel& spline = *level.spline;
  for_each_block(spline, [&](std::size_t b, std::size_t begin) {
    if (l + 1 < levels_.size())
      restrict_block(spline, b, *levels_[l + 1].spline, levels_[l + 1].outer.data(), level.outer.data() + begin);
    else
      std::fill_n(level.outer.data() + begin, SplineLevel::block, 0.0F);
    for (std::size_t i = begin; i < begin + SplineLevel::block; ++i)
      level.load[i] = spline.active[i] ? r[i] - level.outer[i] : 0.0F;
  });
}

void LevelCycle::apply(const std::vector<float>& r, std::vector<float>& x) {
  std::fill(x.begin(), x.end(), 0.0F);
  for (std::size_t l = levels_.size() - 1; l > 0; --l) {
    Level& level = levels_[l];
    restrict_load(l, r.data() + level.spline->first);
    level.residual = level.load;
    float* own = x.data() + level.spline->first;
    smooth(level, own);
    for_each_product(level, own, [&](std::size_t b, const float* product) {
      float* outer = level.outer.data() + b * SplineLevel::block;
      for (std::size_t i = 0; i < SplineLevel::block; ++i) outer[i] += product[i];
    });
  }
  restrict_load(0, r.data());
  solve_coarsest(x.data());
  std::copy_n(x.begin(), levels_[0].sum.size(), levels_[0].sum.begin());
  for (std::size_t l = 1; l < levels_.size(); ++l) {
    Level& level = levels_[l];
    const SplineLevel& spline = *level.spline;
    float* own = x.data() + spline.first;
    for_each_block(spline, [&](std::size_t b, std::size_t begin) {
      prolong_block(spline, b, *levels_[l - 1].spline, levels_[l - 1].sum.data(), level.sum.data() + begin);
      for (std::size_t i = begin; i < begin + SplineLevel::block; ++i) level.sum[i] += own[i];
    });
    for_each_product(level, level.sum.data(), [&](std::size_t b, const float* product) {
      const std::size_t begin = b * SplineLevel::block;
      for (std::size_t i = 0; i < SplineLevel::block; ++i)
        level.residual[begin + i] = level.load[begin + i] - product[i];
    });
    for_each_block(spline, [&](std::size_t, std::size_t begin) {
      for (std::size_t i = begin; i < begin + SplineLevel::block; ++i) level.sum[i] -= own[i];
    });
    smooth(level, own);
    for_each_block(spline, [&](std::size_t, std::size_t begin) {
      for (std::size_t i = begin; i < begin + SplineLevel::block; ++i) level.sum[i] += own[i];
    });
  }
}

void LevelCycle::factorise_coarsest() {
  const Level& level = levels_.front();
  for (std::size_t i = 0; i < level.spline->active.size(); ++i)
    if (level.spline->active[i]) coarsest_functions_.push_back(i);
  const auto n = static_cast<Eigen::Index>(coarsest_functions_.size());
  Eigen::MatrixXd matrix(n, n);
  std::vector<float> unit(level.spline->size(), 0.0F), column(unit.size());
  for (Eigen::Index j = 0; j < n; ++j) {
    unit[coarsest_functions_[static_cast<std::size_t>(j)]] = 1.0F;
    for_each_product(level, unit.data(), [&](std::size_t b, const float* product) {
      std::copy_n(product, SplineLevel::block, column.data() + b * SplineLevel::block);
    });
    unit[coarsest_functions_[static_cast<std::size_t>(j)]] = 0.0F;
    for (Eigen::Index i = 0; i < n; ++i)
      matrix(i, j) = static_cast<double>(column[coarsest_functions_[static_cast<std::size_t>(i)]]);
  }
  coarsest_.compute(0.5 * (matrix + matrix.transpose()));
}

void LevelCycle::solve_coarsest(float* x) {
  Eigen::VectorXd right(static_cast<Eigen::Index>(coarsest_functions_.size()));
  for (Eigen::Index i = 0; i < right.size(); ++i)
    right[i] = static_cast<double>(levels_[0].load[coarsest_functions_[static_cast<std::size_t>(i)]]);
  const Eigen::VectorXd solution = coarsest_.solve(right);
  for (Eigen::Index i = 0; i < right.size(); ++i)
    x[coarsest_functions_[static_cast<std::size_t>(i)]] = static_cast<float>(solution[i]);
}

}  // namespace rhizodont
