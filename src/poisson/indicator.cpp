// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Screened Poisson reconstruction (Kazhdan, Bolitho and Hoppe 2006; Kazhdan and Hoppe 2013) on a regular B-spline grid
// that fits the samples' box, with the function zero outside.
#include "poisson/indicator.hpp"

#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "poisson/bspline.hpp"
#include "poisson/multigrid.hpp"
#include "poisson/normal_field.hpp"
#include "poisson/surface_shares.hpp"
#include "rhizodont/error.hpp"

namespace rhizodont {
namespace {

constexpr double largest_grid = 40e6;  // cells: about 4 GB

void check_options(const IndicatorOptions& options) {
  const auto require = [](bool holds, const char* sentence) {
    if (!holds) throw UsageError(sentence);
  };
  require(options.spacing > 0.01 && options.spacing <= 10.0,
          "The indicator's spacing must lie between 0.01 and 10 mm.");
  require(options.degree == 1 || options.degree == 2, "The indicator's degree must be 1 or 2.");
  require(options.screening >= 0.0 && std::isfinite(options.screening), "The screening must be a number from 0 on.");
  require(options.margin > 0.0 && options.margin < 1e3, "The indicator's margin must lie between 0 and 1000 mm.");
  require(options.samples_per_cell > 0.0 && std::isfinite(options.samples_per_cell),
          "The number of samples per cell must be positive.");
  require(options.neighbours >= 3 && options.neighbours <= 100, "The number of neighbours must lie between 3 and 100.");
  require(options.tolerance > 0.0 && options.tolerance < 1.0, "The solver's tolerance must lie between 0 and 1.");
  require(options.max_cycles >= 1, "The solver needs at least one cycle.");
}

/// The samples with unit normals.
OrientedPoints checked_samples(const OrientedPoints& samples, std::span<const double> weights) {
  const std::size_t count = samples.points.size();
  if (samples.normals.size() != count)
    throw InputError(fmt::format("There are {} points but {} normals.", count, samples.normals.size()));
  if (!weights.empty() && weights.size() != count)
    throw InputError(fmt::format("There are {} points but {} weights.", count, weights.size()));
  if (count < 10) throw InputError(fmt::format("{} points are too few to tell a surface; 10 are the least.", count));
  std::vector<std::int64_t> bad_points, bad_normals, bad_weights;
  OrientedPoints unit = samples;
  for (std::size_t s = 0; s < count; ++s) {
    const auto id = static_cast<std::int64_t>(s);
    if (!samples.points[s].allFinite()) bad_points.push_back(id);
    const double length = samples.normals[s].stableNorm();
    if (!std::isfinite(length) || !(length > 0.0)) bad_normals.push_back(id);
    if (!weights.empty() && !(std::isfinite(weights[s]) && weights[s] >= 0.0)) bad_weights.push_back(id);
    unit.normals[s] /= length;
  }
  if (!bad_points.empty()) throw InputError("Some points have coordinates that are not numbers.", bad_points);
  if (!bad_normals.empty()) throw InputError("Some normals are zero or not numbers.", bad_normals);
  if (!bad_weights.empty()) throw InputError("Some weights are negative or not numbers.", bad_weights);
  return unit;
}

/// Covers the samples with the margin. Cells come in multiples of 8, so that coarser grids cover the same box, and no
/// side is so much shorter than another that the coarsest grid would stay large.
SplineGrid fitted_grid(const std::vector<Point>& points, const IndicatorOptions& options) {
  Eigen::AlignedBox3d box;
  for (const Point& p : points) box.extend(p);
  const double margin = std::max(options.margin, 3.0 * options.spacing);
  SplineGrid grid;
  grid.degree = options.degree;
  grid.spacing = options.spacing;
  const Eigen::Array3d wanted = ((box.sizes().array() + 2.0 * margin) / options.spacing).max(1.0);
  const double least = wanted.maxCoeff() / 16.0;
  const Eigen::Array3d cells = (wanted.max(least) / 8.0).ceil() * 8.0;
  if (!(cells.prod() <= largest_grid))
    throw UsageError(
        fmt::format("A spacing of {} mm is too fine for points that extend over {:.4g} x {:.4g} x {:.4g} mm (are they "
                    "in millimetres, "
                    "and is there none far away from the others?).",
                    options.spacing, box.sizes().x(), box.sizes().y(), box.sizes().z()));
  for (std::size_t axis = 0; axis < 3; ++axis)
    grid.cells[axis] = static_cast<int>(cells[static_cast<Eigen::Index>(axis)]);
  grid.origin = box.center() - 0.5 * options.spacing * cells.matrix();
  return grid;
}

/// Each sample pulls with its share of the surface over the width of the solution's step there.
std::vector<ScreeningSample> screening_samples(const SplineGrid& grid, const OrientedPoints& samples,
                                               std::span<const double> shares, std::span<const double> weights,
                                               const IndicatorOptions& options) {
  std::vector<ScreeningSample> screening(samples.points.size());
  for (std::size_t s = 0; s < screening.size(); ++s) {
    const double confidence = weights.empty() ? 1.0 : weights[s];
    const double width = smearing_width(grid, shares[s], options.samples_per_cell);
    screening[s] = {samples.points[s], options.screening * confidence * shares[s] / width};
  }
  return screening;
}

double weighted_mean(const IndicatorFunction& function, const std::vector<Point>& points,
                     std::span<const double> shares, std::span<const double> weights) {
  std::vector<double> values(points.size());
  tbb::parallel_for(std::size_t{0}, points.size(), [&](std::size_t s) { values[s] = function.value(points[s]); });
  const double confidence = std::accumulate(weights.begin(), weights.end(), 0.0);
  double sum = 0.0, total = 0.0;
  for (std::size_t s = 0; s < points.size(); ++s) {
    const double weight = shares[s] * (confidence > 0.0 ? weights[s] : 1.0);
    sum += weight * values[s];
    total += weight;
  }
  return sum / total;
}

}  // namespace

FieldSample IndicatorFunction::evaluate(const Point& p) const {
  FieldSample sample;
  const Eigen::Array3d at = (p - box_.min()).array() / spacing_;
  const Eigen::Array3d cells(size_[0] - degree_, size_[1] - degree_, size_[2] - degree_);
  if (!(at >= 0.0).all() || !(at <= cells).all()) return sample;
  std::array<std::size_t, 3> first{};
  std::array<std::array<double, 3>, 3> values, slopes;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<Eigen::Index>(axis);
    const double cell = std::min(std::floor(at[a]), cells[a] - 1.0);
    first[axis] = static_cast<std::size_t>(cell);
    values[axis] = spline_values(degree_, at[a] - cell);
    slopes[axis] = spline_derivatives(degree_, at[a] - cell);
  }
  const auto row = static_cast<std::size_t>(size_[0]), plane = row * static_cast<std::size_t>(size_[1]);
  const auto count = static_cast<std::size_t>(degree_ + 1);
  for (std::size_t k = 0; k < count; ++k)
    for (std::size_t j = 0; j < count; ++j) {
      const double* line = coefficients_.data() + (first[2] + k) * plane + (first[1] + j) * row + first[0];
      double value = 0.0, slope = 0.0;
      for (std::size_t i = 0; i < count; ++i) {
        value += values[0][i] * line[i];
        slope += slopes[0][i] * line[i];
      }
      const double yz = values[1][j] * values[2][k];
      sample.value += yz * value;
      sample.gradient +=
          Eigen::Vector3d(yz * slope, slopes[1][j] * values[2][k] * value, values[1][j] * slopes[2][k] * value);
    }
  sample.gradient /= spacing_;
  return sample;
}

double IndicatorFunction::value(const Point& p) const { return evaluate(p).value; }

Eigen::Vector3d IndicatorFunction::gradient(const Point& p) const { return evaluate(p).gradient; }

IndicatorFunction solve_indicator(const OrientedPoints& samples, std::span<const double> weights,
                                  const IndicatorOptions& options) {
  check_options(options);
  const OrientedPoints unit = checked_samples(samples, weights);
  const SplineGrid grid = fitted_grid(unit.points, options);
  const std::vector<double> shares = surface_shares(unit, options.neighbours);
  const double area = std::accumulate(shares.begin(), shares.end(), 0.0);
  if (!(area > 0.0)) throw InputError("All points lie in one place.");

  std::vector<double> load(grid.size(), 0.0);
  add_normal_load(grid, unit, shares, options.samples_per_cell, load);
  const auto screening = screening_samples(grid, unit, shares, weights, options);
  ScreeningOperator<double>(grid, screening).add_load(0.5, load);
  const PoissonSolution solution = solve_screened_poisson(grid, screening, load, options.tolerance, options.max_cycles);
  if (!(solution.relative_residual <= 1.01 * options.tolerance))
    throw NoResultError(fmt::format("The surface's equation was solved to {:.1e} only, not to {:.1e}, in {} cycles.",
                                    solution.relative_residual, options.tolerance, solution.cycles));

  IndicatorFunction function;
  function.degree_ = grid.degree;
  function.spacing_ = grid.spacing;
  for (std::size_t axis = 0; axis < 3; ++axis) function.size_[axis] = grid.cells[axis] + grid.degree;
  const Eigen::Vector3d extent(grid.cells[0], grid.cells[1], grid.cells[2]);
  function.box_ = {grid.origin, grid.origin + grid.spacing * extent};
  function.coefficients_.reserve(static_cast<std::size_t>(function.size_[0]) *
                                 static_cast<std::size_t>(function.size_[1]) *
                                 static_cast<std::size_t>(function.size_[2]));
  for (int z = -grid.degree; z < grid.cells[2]; ++z)
    for (int y = -grid.degree; y < grid.cells[1]; ++y) {
      const double* line = solution.coefficients.data() + grid.index(-grid.degree, y, z);
      function.coefficients_.insert(function.coefficients_.end(), line, line + function.size_[0]);
    }
  function.statistics_ = {solution.cycles, solution.relative_residual, grid.cells, area};
  function.iso_value_ = weighted_mean(function, unit.points, shares, weights);
  return function;
}

}  // namespace rhizodont
