// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Conjugate gradients in double, preconditioned by one symmetric multigrid cycle in single precision. The spline spaces
// of halved grids are nested, so prolongation is exact and its transpose restricts. The smoother is a Chebyshev
// polynomial (Adams, Brezina, Hu, Tuminaro 2003) over a diagonal that bounds the operator: the Laplacian's largest
// eigenvalue plus the screening's row sums, so no eigenvalue has to be estimated.
#include "poisson/multigrid.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "poisson/kernels.hpp"
#include "poisson/stencils.hpp"

namespace rhizodont {
namespace {

constexpr int smoothing_degree = 3;
constexpr double smoothed_part = 1.0 / 20.0;  // of the spectrum's top: what lies below is left to the coarser grid
constexpr std::size_t chunk = 1 << 14;

template <class Body>
void for_each_chunk(std::size_t size, const Body& body) {
  tbb::parallel_for(std::size_t{0}, (size + chunk - 1) / chunk,
                    [&](std::size_t c) { body(c, c * chunk, std::min(size, (c + 1) * chunk)); });
}

/// Sum over fixed chunks, so that rounding does not depend on the threads.
double dot(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> sums((a.size() + chunk - 1) / chunk);
  for_each_chunk(a.size(), [&](std::size_t c, std::size_t begin, std::size_t end) {
    sums[c] = Eigen::Map<const Eigen::VectorXd>(a.data() + begin, static_cast<Eigen::Index>(end - begin))
                  .dot(Eigen::Map<const Eigen::VectorXd>(b.data() + begin, static_cast<Eigen::Index>(end - begin)));
  });
  return std::accumulate(sums.begin(), sums.end(), 0.0);
}

/// One grid of the hierarchy, in single precision.
class Level {
 public:
  Level(const SplineGrid& g, const std::vector<ScreeningSample>& samples)
      : grid(g),
        x(g.size()),
        r(g.size()),
        laplace_(g),
        screening_(g, samples),
        direction_(g.size()),
        product_(g.size()) {
    std::vector<float> row_sums(g.size(), 0.0F);
    screening_.add_load(1.0F, row_sums);
    inverse_bound_.assign(g.size(), 0.0F);
    const auto bound = static_cast<float>(laplace_.largest_eigenvalue());
    for (int z = 0; z < g.functions(2); ++z)
      for (int y = 0; y < g.functions(1); ++y)
        for (int i = 0; i < g.functions(0); ++i)
          inverse_bound_[g.index(i, y, z)] = 1.0F / (bound + row_sums[g.index(i, y, z)]);
  }

  void apply(const std::vector<float>& u, std::vector<float>& out) {
    laplace_.apply(u, out);
    screening_.add(u, out);
  }

  /// Improves x for A x = b where r = b - A x comes in; r is out of date by the last step afterwards.
  void smooth() {
    const double middle = 0.5 * (1.0 + smoothed_part), half = 0.5 * (1.0 - smoothed_part), ratio = middle / half;
    double rho = 1.0 / ratio;
    step(0.0, 1.0 / middle, false);
    for (int k = 1; k < smoothing_degree; ++k) {
      const double next = 1.0 / (2.0 * ratio - rho);
      apply(direction_, product_);
      step(next * rho, 2.0 * next / half, true);
      rho = next;
    }
  }

  /// Brings r up to date after `smooth`.
  void finish_residual() {
    apply(direction_, product_);
    for_each_chunk(r.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) r[i] -= product_[i];
    });
  }

  /// Adds the coarse correction, and brings r up to date.
  void correct(const SplineGrid& fine, const std::vector<float>& coarse) {
    std::fill(direction_.begin(), direction_.end(), 0.0F);
    prolong_add(fine, coarse, direction_);
    for_each_chunk(x.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) x[i] += direction_[i];
    });
    finish_residual();
  }

  SplineGrid grid;
  std::vector<float> x, r;

 private:
  void step(double keep, double scale, bool changed) {
    for_each_chunk(x.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
      chebyshev_step(end - begin, static_cast<float>(keep), static_cast<float>(scale), inverse_bound_.data() + begin,
                     changed ? product_.data() + begin : nullptr, r.data() + begin, direction_.data() + begin,
                     x.data() + begin);
    });
  }

  LaplaceStencil<float> laplace_;
  ScreeningOperator<float> screening_;
  std::vector<float> direction_, product_, inverse_bound_;
};

/// The functions inside the box of a small grid, as a dense factorised matrix.
class DenseSolver {
 public:
  explicit DenseSolver(Level& level) {
    const SplineGrid& g = level.grid;
    for (int z = 0; z < g.functions(2); ++z)
      for (int y = 0; y < g.functions(1); ++y)
        for (int i = 0; i < g.functions(0); ++i) positions_.push_back(g.index(i, y, z));
    const auto n = static_cast<Eigen::Index>(positions_.size());
    Eigen::MatrixXd matrix(n, n);
    std::vector<float> unit(g.size(), 0.0F), column(g.size(), 0.0F);
    for (Eigen::Index j = 0; j < n; ++j) {
      unit[positions_[static_cast<std::size_t>(j)]] = 1.0F;
      level.apply(unit, column);
      unit[positions_[static_cast<std::size_t>(j)]] = 0.0F;
      for (Eigen::Index i = 0; i < n; ++i)
        matrix(i, j) = static_cast<double>(column[positions_[static_cast<std::size_t>(i)]]);
    }
    factor_.compute(0.5 * (matrix + matrix.transpose()));
  }

  void solve(const std::vector<float>& r, std::vector<float>& x) const {
    Eigen::VectorXd right(static_cast<Eigen::Index>(positions_.size()));
    for (Eigen::Index i = 0; i < right.size(); ++i)
      right[i] = static_cast<double>(r[positions_[static_cast<std::size_t>(i)]]);
    const Eigen::VectorXd solution = factor_.solve(right);
    for (Eigen::Index i = 0; i < right.size(); ++i)
      x[positions_[static_cast<std::size_t>(i)]] = static_cast<float>(solution[i]);
  }

 private:
  std::vector<std::size_t> positions_;
  Eigen::LLT<Eigen::MatrixXd> factor_;
};

class Multigrid {
 public:
  Multigrid(const SplineGrid& grid, const std::vector<ScreeningSample>& samples) {
    std::vector<ScreeningSample> merged = samples;
    SplineGrid g = grid;
    levels_.push_back(std::make_unique<Level>(g, merged));
    while (std::ranges::max(g.cells) > 8 && std::ranges::min(g.cells) / 2 > g.degree) {
      g = g.coarser();
      merged = merge_samples(g, merged);
      levels_.push_back(std::make_unique<Level>(g, merged));
    }
    coarsest_ = std::make_unique<DenseSolver>(*levels_.back());
  }

  Level& finest() { return *levels_.front(); }

  /// x = about A^-1 r on the level, by one V-cycle; r is used up.
  void cycle(std::size_t l) {
    Level& level = *levels_[l];
    if (l + 1 == levels_.size()) {
      coarsest_->solve(level.r, level.x);
      return;
    }
    std::fill(level.x.begin(), level.x.end(), 0.0F);
    level.smooth();
    level.finish_residual();
    restrict_field(level.grid, level.r, levels_[l + 1]->r);
    cycle(l + 1);
    level.correct(level.grid, levels_[l + 1]->x);
    level.smooth();
  }

  /// x = about A^-1 r on the finest level: the coarsest problem first, each solution the start of the next finer one.
  void full_cycle() {
    const std::vector<float> load = finest().r;
    std::vector<std::vector<float>> loads{load};
    for (std::size_t l = 0; l + 1 < levels_.size(); ++l) {
      loads.emplace_back(levels_[l + 1]->grid.size(), 0.0F);
      restrict_field(levels_[l]->grid, loads[l], loads[l + 1]);
    }
    levels_.back()->r = loads.back();
    cycle(levels_.size() - 1);
    for (std::size_t l = levels_.size() - 1; l-- > 0;) {
      Level& level = *levels_[l];
      std::vector<float> start(level.grid.size(), 0.0F), product(level.grid.size(), 0.0F);
      prolong_add(level.grid, levels_[l + 1]->x, start);
      level.apply(start, product);
      for (std::size_t i = 0; i < product.size(); ++i) level.r[i] = loads[l][i] - product[i];
      cycle(l);
      for (std::size_t i = 0; i < product.size(); ++i) level.x[i] += start[i];
    }
  }

 private:
  std::vector<std::unique_ptr<Level>> levels_;
  std::unique_ptr<DenseSolver> coarsest_;
};

/// The operator in double.
class ScreenedLaplacian {
 public:
  ScreenedLaplacian(const SplineGrid& grid, const std::vector<ScreeningSample>& samples)
      : laplace_(grid), screening_(grid, samples) {}
  void apply(const std::vector<double>& u, std::vector<double>& out) {
    laplace_.apply(u, out);
    screening_.add(u, out);
  }

 private:
  LaplaceStencil<double> laplace_;
  ScreeningOperator<double> screening_;
};

}  // namespace

void apply_screened_laplacian(const SplineGrid& grid, const std::vector<ScreeningSample>& samples,
                              const SplineField<double>& u, SplineField<double>& out) {
  ScreenedLaplacian(grid, samples).apply(u, out);
}

PoissonSolution solve_screened_poisson(const SplineGrid& grid, const std::vector<ScreeningSample>& samples,
                                       const SplineField<double>& load, double tolerance, int max_cycles) {
  PoissonSolution solution;
  solution.coefficients.assign(grid.size(), 0.0);
  std::vector<double>& x = solution.coefficients;
  const double norm = std::sqrt(dot(load, load));
  if (!(norm > 0.0)) return solution;

  ScreenedLaplacian laplacian(grid, samples);
  Multigrid multigrid(grid, samples);
  std::vector<double> r = load, p(grid.size(), 0.0), q(grid.size(), 0.0), z(grid.size(), 0.0);
  const auto precondition = [&](bool full) {
    // Scaled to unit size, so that single precision holds it whatever the residual.
    const double scale = std::sqrt(dot(r, r));
    Level& finest = multigrid.finest();
    for_each_chunk(r.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) finest.r[i] = static_cast<float>(r[i] / scale);
    });
    full ? multigrid.full_cycle() : multigrid.cycle(0);
    for_each_chunk(r.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) z[i] = scale * static_cast<double>(finest.x[i]);
    });
  };

  // The first direction is a full multigrid solve, those that follow are single cycles. Each is made conjugate to the
  // one before explicitly, since the preconditioner is not quite the same from step to step (Notay 2000).
  double curvature = 0.0;
  for (int cycle = 1; cycle <= max_cycles; ++cycle) {
    precondition(cycle == 1);
    const double beta = cycle == 1 ? 0.0 : -dot(z, q) / curvature;
    for_each_chunk(p.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) p[i] = z[i] + beta * p[i];
    });
    laplacian.apply(p, q);
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
    if (std::sqrt(dot(r, r)) <= tolerance * norm) break;
  }
  // The recursion's residual drifts from the true one by rounding: report the true one.
  laplacian.apply(x, q);
  for_each_chunk(r.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) r[i] = load[i] - q[i];
  });
  solution.relative_residual = std::sqrt(dot(r, r)) / norm;
  return solution;
}

}  // namespace rhizodont
