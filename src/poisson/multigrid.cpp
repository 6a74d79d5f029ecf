// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Conjugate gradients in double over the functions of all levels, preconditioned by one multigrid cycle in single
// precision. That set of functions is redundant; the operator is then singular but consistent, and conjugate gradients
// do not mind (Griebel 1994, multilevel algorithms as iterations over generating systems).
#include "poisson/multigrid.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "base/parallel_tasks.hpp"
#include "poisson/bspline.hpp"
#include "poisson/level_cycle.hpp"

namespace rhizodont {
namespace {

constexpr std::size_t chunk = 1 << 13;

template <class Body>
void for_each_chunk(std::size_t size, const Body& body) {
  tbb::parallel_for(std::size_t{0}, (size + chunk - 1) / chunk,
                    [&](std::size_t c) { body(c, c * chunk, std::min(size, (c + 1) * chunk)); });
}

/// Sum over fixed chunks, so that rounding does not depend on the threads.
double dot(const LevelField& a, const LevelField& b) {
  std::vector<double> sums((a.size() + chunk - 1) / chunk);
  for_each_chunk(a.size(), [&](std::size_t c, std::size_t begin, std::size_t end) {
    sums[c] = Eigen::Map<const Eigen::VectorXd>(a.data() + begin, static_cast<Eigen::Index>(end - begin))
                  .dot(Eigen::Map<const Eigen::VectorXd>(b.data() + begin, static_cast<Eigen::Index>(end - begin)));
  });
  return std::accumulate(sums.begin(), sums.end(), 0.0);
}

SymmetricTaps<double> taps(const std::array<double, 5>& table) { return {table[2], table[3], table[4]}; }

/// The sums on level l from those on the level below.
void accumulate_level(const std::vector<SplineLevel>& levels, std::size_t l, const LevelField& coefficients,
                      LevelField& sums) {
  const SplineLevel& level = levels[l];
  tbb::parallel_for(std::size_t{0}, level.blocks.size(), [&](std::size_t b) {
    const std::size_t begin = level.first + b * SplineLevel::block;
    if (l > 0)
      prolong_block(level, b, levels[l - 1], sums.data() + levels[l - 1].first, sums.data() + begin);
    else
      std::fill_n(sums.data() + begin, SplineLevel::block, 0.0);
    for (std::size_t i = begin; i < begin + SplineLevel::block; ++i) sums[i] += coefficients[i];
  });
}

}  // namespace

std::size_t field_size(const std::vector<SplineLevel>& levels) { return levels.back().first + levels.back().size(); }

LevelField accumulated(const std::vector<SplineLevel>& levels, const LevelField& coefficients) {
  LevelField sums(field_size(levels));
  for (std::size_t l = 0; l < levels.size(); ++l) accumulate_level(levels, l, coefficients, sums);
  return sums;
}

ScreenedLaplacian::ScreenedLaplacian(const std::vector<SplineLevel>& levels,
                                     const std::vector<std::vector<ScreeningSample>>& samples)
    : levels_(levels), samples_(levels.size()), sums_(field_size(levels)), outer_(field_size(levels)) {
  parallel_tasks(levels.size(), [&](std::size_t l) { samples_[l] = BlockSamples<double>(levels[l], samples[l]); });
}

void ScreenedLaplacian::apply(const LevelField& coefficients, LevelField& out) {
  for (std::size_t l = 0; l < levels_.size(); ++l) accumulate_level(levels_, l, coefficients, sums_);
  // Level by level from the finest: what its own and finer functions contribute (`outer_`, also beyond the active
  // functions) passes on to coarser levels; what coarser functions contribute on this level is part of `sums_`.
  for (std::size_t l = levels_.size(); l-- > 0;) {
    const SplineLevel& level = levels_[l];
    const SplineTables tables = spline_tables(level.degree);
    const auto mass = taps(tables.mass), stiffness = taps(tables.stiffness);
    tbb::parallel_for(std::size_t{0}, level.blocks.size(), [&](std::size_t b) {
      std::array<double, largest_patch> patch, scratch;
      std::array<double, SplineLevel::block> shared{}, own, all;
      const std::size_t begin = level.first + b * SplineLevel::block;
      gather_patch(level, coefficients.data() + level.first, b, patch.data());
      block_stiffness(level.degree, mass, stiffness, patch.data(), own.data());
      gather_patch(level, sums_.data() + level.first, b, patch.data());
      block_stiffness(level.degree, mass, stiffness, patch.data(), all.data());
      if (l + 1 < levels_.size())
        restrict_block(level, b, levels_[l + 1], outer_.data() + levels_[l + 1].first, shared.data());
      add_screening<double>(level, samples_[l].of(b), patch.data(), scratch.data(), shared.data());
      for (std::size_t i = 0; i < SplineLevel::block; ++i) {
        outer_[begin + i] = shared[i] + level.spacing * own[i];
        out[begin + i] = level.active[b * SplineLevel::block + i] ? shared[i] + level.spacing * all[i] : 0.0;
      }
    });
  }
}

void add_screening_load(const std::vector<SplineLevel>& levels,
                        const std::vector<std::vector<ScreeningSample>>& samples, double value, LevelField& load) {
  LevelField outer(field_size(levels), 0.0);
  for (std::size_t l = levels.size(); l-- > 0;) {
    const SplineLevel& level = levels[l];
    double* field = outer.data() + level.first;
    if (l + 1 < levels.size())
      tbb::parallel_for(std::size_t{0}, level.blocks.size(), [&](std::size_t b) {
        restrict_block(level, b, levels[l + 1], outer.data() + levels[l + 1].first, field + b * SplineLevel::block);
      });
    for (const ScreeningSample& sample : samples[l])
      for_each_function(level, sample.position,
                        [&](std::size_t f, double spline) { field[f] += value * sample.weight * spline; });
    for (std::size_t i = 0; i < level.size(); ++i)
      if (level.active[i]) load[level.first + i] += field[i];
  }
}

PoissonSolution solve_screened_poisson(const std::vector<SplineLevel>& levels,
                                       const std::vector<std::vector<ScreeningSample>>& samples, const LevelField& load,
                                       double tolerance, int max_cycles) {
  PoissonSolution solution;
  solution.coefficients.assign(load.size(), 0.0);
  LevelField& x = solution.coefficients;
  const double norm = std::sqrt(dot(load, load));
  if (!(norm > 0.0)) return solution;

  std::optional<ScreenedLaplacian> laplacian;
  std::optional<LevelCycle> cycle_on_levels;
  parallel_pair([&] { laplacian.emplace(levels, samples); }, [&] { cycle_on_levels.emplace(levels, samples); });
  LevelField r = load, p(load.size(), 0.0), q(load.size(), 0.0), z(load.size(), 0.0);
  std::vector<float> single_r(load.size()), single_z(load.size());
  const auto precondition = [&](double size) {
    // Scaled to unit size, so that single precision holds it whatever the residual.
    for_each_chunk(r.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) single_r[i] = static_cast<float>(r[i] / size);
    });
    cycle_on_levels->apply(single_r, single_z);
    for_each_chunk(r.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) z[i] = size * static_cast<double>(single_z[i]);
    });
  };

  // Each direction is made conjugate to the one before explicitly, since the preconditioner is not quite linear in
  // single precision (Notay 2000).
  double curvature = 0.0, size = norm;
  for (int cycle = 1; cycle <= max_cycles; ++cycle) {
    precondition(size);
    const double beta = cycle == 1 ? 0.0 : -dot(z, q) / curvature;
    for_each_chunk(p.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) p[i] = z[i] + beta * p[i];
    });
    laplacian->apply(p, q);
    curvature = dot(p, q);
    if (!(curvature > 0.0)) break;
    const double alpha = dot(p, r) / curvature;
    for_each_chunk(p.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        x[i] += alpha * p[i];
        r[i] -= alpha * q[i];
      }
    });
    solution.cycles = cycle;
    size = std::sqrt(dot(r, r));
    if (size <= tolerance * norm) break;
  }
  // The recursion's residual drifts from the true one by rounding: report the true one.
  laplacian->apply(x, q);
  for_each_chunk(r.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) r[i] = load[i] - q[i];
  });
  solution.relative_residual = std::sqrt(dot(r, r)) / norm;
  return solution;
}

}  // namespace rhizodont
