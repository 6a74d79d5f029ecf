// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Screened Poisson reconstruction (Kazhdan, Bolitho and Hoppe 2006; Kazhdan and Hoppe 2013) with B-splines on levels of
// a box around the samples, with the function zero outside.
#include "poisson/indicator.hpp"

#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "base/option_range.hpp"
#include "base/parallel_tasks.hpp"
#include "poisson/bspline.hpp"
#include "poisson/multigrid.hpp"
#include "poisson/normal_field.hpp"
#include "poisson/spline_level.hpp"
#include "poisson/surface_shares.hpp"
#include "rhizodont/error.hpp"

namespace rhizodont {
namespace {

constexpr double largest_directory = 3e7;  // blocks that the finest level would have if it were complete

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

LevelLayout fitted_layout(const std::vector<Point>& points, const LevelOptions& options) {
  Eigen::AlignedBox3d box;
  for (const Point& p : points) box.extend(p);
  const LevelLayout layout = lay_out_levels(box, options);
  if (!(layout.directory_size() <= largest_directory))
    throw UsageError(
        fmt::format("A spacing of {} mm is too fine for points that extend over {:.4g} x {:.4g} x {:.4g} mm (are they "
                    "in millimetres, and is there none far away from the others?).",
                    options.spacing, box.sizes().x(), box.sizes().y(), box.sizes().z()));
  return layout;
}

/// The samples with the levels that they ask for.
struct Depths {
  std::vector<double> width;  // mm, of the splines that suit the sample's density
  std::vector<double> depth;  // the level with such splines, between two levels as a rule
  std::vector<LevelSample> reach;
};

Depths depths_of(const std::vector<Point>& points, std::span<const double> shares, const LevelLayout& layout,
                 double samples_per_cell) {
  const double finest = layout.spacing(layout.count - 1);
  Depths depths;
  for (std::size_t s = 0; s < points.size(); ++s) {
    const double width = std::clamp(std::sqrt(samples_per_cell * shares[s]), finest, layout.coarsest_spacing);
    const double depth = std::clamp(layout.count - 1 - std::log2(width / finest), 0.0, layout.count - 1.0);
    depths.width.push_back(width);
    depths.depth.push_back(depth);
    depths.reach.push_back({points[s], static_cast<int>(std::round(depth))});
  }
  return depths;
}

bool touches_active(const SplineLevel& level, const Point& p) {
  bool touches = false;
  for_each_function(level, p, [&](std::size_t f, double) { touches = touches || level.active[f]; });
  return touches;
}

/// Each sample pulls with its share of the surface over the width of the solution's step there, on the finest level
/// that knows of it; of several in a cell their mean pulls, as in Kazhdan and Hoppe's adaptive discretisation.
std::vector<std::vector<ScreeningSample>> screening_samples(const std::vector<SplineLevel>& levels,
                                                            const std::vector<Point>& points,
                                                            std::span<const double> shares,
                                                            std::span<const double> width,
                                                            std::span<const double> weights, double screening) {
  std::vector<std::size_t> level_of(points.size());
  tbb::parallel_for(std::size_t{0}, points.size(), [&](std::size_t s) {
    std::size_t l = levels.size() - 1;
    while (l > 0 && !touches_active(levels[l], points[s])) --l;
    level_of[s] = l;
  });
  std::vector<std::vector<ScreeningSample>> samples(levels.size());
  for (std::size_t s = 0; s < points.size(); ++s) {
    const double confidence = weights.empty() ? 1.0 : weights[s];
    samples[level_of[s]].push_back({points[s], screening * confidence * shares[s] / width[s]});
  }
  for (std::size_t l = 0; l < levels.size(); ++l) samples[l] = merge_samples(levels[l], samples[l]);
  return samples;
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

void require_in_range(const IndicatorOptions& options) {
  require_ranges("the indicator function", {{"spacing", options.spacing, OptionRange::above(0.01).at_most(10)},
                                            {"degree", options.degree, OptionRange::at_least(1).at_most(2)},
                                            {"screening", options.screening, OptionRange::at_least(0)},
                                            {"margin", options.margin, OptionRange::above(0).below(1000)},
                                            {"samples_per_cell", options.samples_per_cell, OptionRange::above(0)},
                                            {"neighbours", options.neighbours, OptionRange::at_least(3).at_most(100)},
                                            {"tolerance", options.tolerance, OptionRange::above(0).below(1)},
                                            {"max_cycles", options.max_cycles, OptionRange::at_least(1)}});
}

void IndicatorFunction::store(const std::vector<SplineLevel>& levels, const std::vector<double>& coefficients) {
  const std::vector<double> sums = accumulated(levels, coefficients);
  const int wide = SplineLevel::side + degree_;
  const auto volume = static_cast<std::size_t>(wide) * static_cast<std::size_t>(wide) * static_cast<std::size_t>(wide);
  for (const SplineLevel& spline : levels) {
    Level level;
    level.blocks = {spline.blocks_along(0), spline.blocks_along(1), spline.blocks_along(2)};
    level.directory = spline.directory;
    level.below.assign(spline.blocks.size(), 0);
    level.coefficients.resize(spline.blocks.size() * volume);
    tbb::parallel_for(std::size_t{0}, spline.blocks.size(), [&](std::size_t b) {
      const auto& [x, y, z] = spline.blocks[b];
      for (int n = 0; n < 8; ++n) {
        const std::array<int, 3> at{x - n % 2, y - n / 2 % 2, z - n / 4};
        const bool known = std::ranges::min(at) < 0 || spline.find(at[0], at[1], at[2]) >= 0;
        if (known) level.below[b] = static_cast<std::uint8_t>(level.below[b] | (1 << n));
      }
      gather_box(spline, sums.data() + spline.first,
                 {SplineLevel::side * x - degree_, SplineLevel::side * y - degree_, SplineLevel::side * z - degree_},
                 wide, level.coefficients.data() + b * volume);
    });
    levels_.push_back(std::move(level));
  }
}

/// The coefficients of the functions on a cell of the finest level or of the coarser one around it, whichever is the
/// first to be known.
IndicatorFunction::Cell IndicatorFunction::find_cell(const std::array<int, 3>& finest) const {
  const int wide = SplineLevel::side + degree_;
  const auto volume = static_cast<std::size_t>(wide) * static_cast<std::size_t>(wide) * static_cast<std::size_t>(wide);
  for (std::size_t up = 0; up < levels_.size(); ++up) {
    const Level& level = levels_[levels_.size() - 1 - up];
    const int x = finest[0] >> up, y = finest[1] >> up, z = finest[2] >> up;
    const std::int32_t b =
        level.directory[(static_cast<std::size_t>(z / SplineLevel::side) * static_cast<std::size_t>(level.blocks[1]) +
                         static_cast<std::size_t>(y / SplineLevel::side)) *
                            static_cast<std::size_t>(level.blocks[0]) +
                        static_cast<std::size_t>(x / SplineLevel::side)];
    if (b < 0) continue;
    const int i = x % SplineLevel::side, j = y % SplineLevel::side, k = z % SplineLevel::side;
    // The functions of a cell near the block's lower sides come from the blocks below it.
    const int below = (i < degree_ ? 1 : 0) + (j < degree_ ? 2 : 0) + (k < degree_ ? 4 : 0);
    const std::uint8_t known = level.below[static_cast<std::size_t>(b)];
    bool complete = true;
    for (int n = 1; n < 8; ++n)
      if ((n & below) == n && !(known & (1 << n))) complete = false;
    if (!complete) continue;
    return {level.coefficients.data() + static_cast<std::size_t>(b) * volume +
                static_cast<std::size_t>((k * wide + j) * wide + i),
            static_cast<int>(up)};
  }
  return {nullptr, 0};
}

FieldSample IndicatorFunction::evaluate(const Point& p) const {
  FieldSample sample;
  const Eigen::Array3d at = (p - box_.min()).array() / spacing_;
  const Eigen::Array3d cells(cells_[0], cells_[1], cells_[2]);
  if (!(at >= 0.0).all() || !(at <= cells).all()) return sample;
  std::array<int, 3> finest{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    finest[axis] = std::min(static_cast<int>(at[static_cast<Eigen::Index>(axis)]), cells_[axis] - 1);
  const Cell cell = find_cell(finest);
  const double scale = 1.0 / static_cast<double>(1 << cell.up);
  std::array<std::array<double, 3>, 3> values, slopes;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double t = at[static_cast<Eigen::Index>(axis)] * scale - (finest[axis] >> cell.up);
    values[axis] = spline_values(degree_, t);
    slopes[axis] = spline_derivatives(degree_, t);
  }
  const auto wide = static_cast<std::size_t>(SplineLevel::side + degree_),
             count = static_cast<std::size_t>(degree_ + 1);
  for (std::size_t k = 0; k < count; ++k)
    for (std::size_t j = 0; j < count; ++j) {
      const double* line = cell.first + (k * wide + j) * wide;
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
  sample.gradient *= scale / spacing_;
  return sample;
}

double IndicatorFunction::value(const Point& p) const { return evaluate(p).value; }

Eigen::Vector3d IndicatorFunction::gradient(const Point& p) const { return evaluate(p).gradient; }

IndicatorFunction solve_indicator(const OrientedPoints& samples, std::span<const double> weights,
                                  const IndicatorOptions& options) {
  require_in_range(options);
  const OrientedPoints unit = checked_samples(samples, weights);
  LevelOptions level_options;
  level_options.degree = options.degree;
  level_options.spacing = options.spacing;
  level_options.margin = options.margin;
  const LevelLayout layout = fitted_layout(unit.points, level_options);
  const std::vector<double> shares = surface_shares(unit, options.neighbours);
  const double area = std::accumulate(shares.begin(), shares.end(), 0.0);
  if (!(area > 0.0)) throw InputError("All points lie in one place.");

  const Depths depths = depths_of(unit.points, shares, layout, options.samples_per_cell);
  const std::vector<SplineLevel> levels = build_levels(layout, depths.reach, level_options);
  // Both go through the samples in order, so each has a thread of its own.
  std::vector<std::vector<ScreeningSample>> screening;
  LevelField load, pull(field_size(levels), 0.0);
  parallel_pair([&] { load = normal_load(levels, unit, shares, depths.depth); },
                [&] {
                  screening = screening_samples(levels, unit.points, shares, depths.width, weights, options.screening);
                  add_screening_load(levels, screening, 0.5, pull);
                });
  std::ranges::transform(load, pull, load.begin(), std::plus{});
  const PoissonSolution solution =
      solve_screened_poisson(levels, screening, load, options.tolerance, options.max_cycles);
  if (!(solution.relative_residual <= 1.01 * options.tolerance))
    throw NoResultError(fmt::format("The surface's equation was solved to {:.1e} only, not to {:.1e}, in {} cycles.",
                                    solution.relative_residual, options.tolerance, solution.cycles));

  IndicatorFunction function;
  function.degree_ = options.degree;
  function.spacing_ = layout.spacing(layout.count - 1);
  function.cells_ = levels.back().cells;
  const Eigen::Vector3d extent(function.cells_[0], function.cells_[1], function.cells_[2]);
  function.box_ = {layout.origin, layout.origin + function.spacing_ * extent};
  function.store(levels, solution.coefficients);
  IndicatorStatistics& statistics = function.statistics_;
  statistics = {solution.cycles, solution.relative_residual, layout.count, 0, field_size(levels), area};
  for (const SplineLevel& level : levels)
    statistics.functions += static_cast<std::size_t>(std::ranges::count(level.active, 1));
  function.iso_value_ = weighted_mean(function, unit.points, shares, weights);
  return function;
}

}  // namespace rhizodont
