// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Geometry>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "poisson/field_sample.hpp"
#include "rhizodont/mesh.hpp"

namespace rhizodont {

struct SplineLevel;

/// How `solve_indicator` works. The defaults are the product's.
struct IndicatorOptions {
  double spacing = 0.2;  ///< mm, (0.01, 10]: knot spacing of the finest B-splines, used where samples are dense enough
  int degree = 2;        ///< 1 or 2: of the B-splines; 2 gives a continuous gradient
  double screening = 4.0;  ///< >= 0: pull of the samples towards one common value, relative to the gradient term
  double margin = 1.0;     ///< mm, > 0: least distance from the samples to the box outside which the function is 0
  double samples_per_cell = 0.5;  ///< > 0: where samples are sparser, splines are wider, to have so many per cell
  int neighbours = 10;            ///< [3, 100]: neighbours from which a sample's share of the surface is estimated
  double tolerance = 3e-4;        ///< (0, 1): norm of the residual over the norm of the right-hand side
  int max_cycles = 60;            ///< >= 1: multigrid cycles before giving up
};

/// Throws UsageError for an option out of its range.
void require_in_range(const IndicatorOptions& options);

/// What the solver did.
struct IndicatorStatistics {
  int cycles = 0;                    ///< multigrid cycles
  double relative_residual = 0.0;    ///< norm of the residual over the norm of the right-hand side, in double
  int levels = 0;                    ///< of knot spacings, each half of that before
  std::size_t functions = 0;         ///< B-splines solved for, on all levels
  std::size_t stored_functions = 0;  ///< coefficients kept, with those around
  double sampled_area = 0.0;         ///< mm^2: sum of the samples' shares of the surface
};

/// A smooth function that is about 1 inside a solid and 0 outside. Owns the coefficients of tensor-product B-splines on
/// a box, whose knots are the closer the denser the samples are; safe to evaluate from many threads at once.
class IndicatorFunction {
 public:
  /// The function and its gradient (per mm) at `p` (mm); 0 and zero outside the box and where `p` is not finite.
  FieldSample evaluate(const Point& p) const;
  /// Like `evaluate`, the value alone.
  double value(const Point& p) const;
  /// Like `evaluate`, the gradient alone; it points into the solid.
  Eigen::Vector3d gradient(const Point& p) const;

  /// The value at the surface: the mean over the samples, weighted by their shares of the surface and their confidence.
  double iso_value() const { return iso_value_; }
  /// The box outside which the function is 0 (mm).
  const Eigen::AlignedBox3d& box() const { return box_; }
  const IndicatorStatistics& statistics() const { return statistics_; }
  /// Knot spacing of the finest level (mm).
  double spacing() const { return spacing_; }

 private:
  friend IndicatorFunction solve_indicator(const OrientedPoints&, std::span<const double>, const IndicatorOptions&);
  IndicatorFunction() = default;

  /// Coefficients of one level by blocks of cells, each with all that its cells need: the sum over this and all coarser
  /// levels.
  struct Level {
    std::array<int, 3> blocks = {0, 0, 0};  // of the directory
    std::vector<std::int32_t> directory;    // position of a block of cells, or -1
    std::vector<std::uint8_t> below;        // per block, bits: which of the 8 blocks at or below it are known
    std::vector<double> coefficients;
  };

  struct Cell {
    const double* first;  // coefficient
    int up;               // levels above the finest
  };
  void store(const std::vector<SplineLevel>& levels, const std::vector<double>& coefficients);
  Cell find_cell(const std::array<int, 3>& finest) const;

  int degree_ = 2;
  double spacing_ = 1.0;
  double iso_value_ = 0.5;
  Eigen::AlignedBox3d box_;
  std::array<int, 3> cells_ = {0, 0, 0};  // of the finest level
  std::vector<Level> levels_;             // coarsest first
  IndicatorStatistics statistics_;
};

/// Screened Poisson reconstruction (paper, 3.4; Kazhdan and Hoppe 2013): the B-spline chi that minimises
/// int |grad chi + N|^2 + sum_s w_s (chi(p_s) - 1/2)^2, where N is the samples' smeared outward normal field and w_s
/// grows with the sample's share of the surface and its confidence. Zero on the box's border. The splines are those of
/// an octree's nodes: wide ones everywhere, finer ones only around samples that are dense enough for them, so that work
/// and memory grow with the surface's area over the squared spacing. The result does not depend on the number of
/// threads.
///
/// \param samples  points (mm) that cover the whole closed surface, with outward normals; normals are normalised here
/// \param weights  confidence per sample, >= 0 and finite, 1 = as usual; empty means 1 for all. It scales the pull
///                 to the sample's position, so that e.g. scanned points count more than predicted ones
/// \throws InputError   fewer than 10 samples, non-finite points, zero or non-finite normals, bad weights (ids =
/// samples);
///                      all samples in one place
/// \throws UsageError   an option out of its range, or a spacing that is too fine for the extent of the samples
/// \throws NoResultError the solver did not reach the tolerance
IndicatorFunction solve_indicator(const OrientedPoints& samples, std::span<const double> weights = {},
                                  const IndicatorOptions& options = {});

}  // namespace rhizodont
