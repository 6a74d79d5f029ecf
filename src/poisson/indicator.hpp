// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Geometry>

#include <array>
#include <span>
#include <vector>

#include "poisson/field_sample.hpp"
#include "rhizodont/mesh.hpp"

namespace rhizodont {

/// How `solve_indicator` works. The defaults are the product's.
struct IndicatorOptions {
  double spacing = 0.2;    ///< mm, (0.01, 10]: knot spacing of the finest B-spline grid
  int degree = 2;          ///< 1 or 2: of the B-splines; 2 gives a continuous gradient
  double screening = 4.0;  ///< >= 0: pull of the samples towards one common value, relative to the gradient term
  double margin = 1.0;     ///< mm, > 0: least distance from the samples to the box outside which the function is 0
  double samples_per_cell = 0.5;  ///< > 0: the normals of sparser samples are smeared wider, to have so many per cell
  int neighbours = 10;            ///< [3, 100]: neighbours from which a sample's share of the surface is estimated
  double tolerance = 1e-6;        ///< (0, 1): norm of the residual over the norm of the right-hand side
  int max_cycles = 60;            ///< >= 1: multigrid cycles before giving up
};

/// What the solver did.
struct IndicatorStatistics {
  int cycles = 0;                        ///< multigrid cycles on the finest grid
  double relative_residual = 0.0;        ///< norm of the residual over the norm of the right-hand side
  std::array<int, 3> cells = {0, 0, 0};  ///< of the finest grid along x, y, z
  double sampled_area = 0.0;             ///< mm^2: sum of the samples' shares of the surface
};

/// A smooth function that is about 1 inside a solid and 0 outside. Owns the coefficients of a tensor-product B-spline
/// on a box; safe to evaluate from many threads at once.
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
  /// Knot spacing of the finest grid (mm).
  double spacing() const { return spacing_; }

 private:
  friend IndicatorFunction solve_indicator(const OrientedPoints&, std::span<const double>, const IndicatorOptions&);
  IndicatorFunction() = default;

  int degree_ = 2;
  double spacing_ = 1.0;
  double iso_value_ = 0.5;
  Eigen::AlignedBox3d box_;
  std::array<int, 3> size_ = {0, 0, 0};  // stored coefficients along x, y, z: as many as cells plus the degree
  std::vector<double> coefficients_;     // x runs fastest
  IndicatorStatistics statistics_;
};

/// Screened Poisson reconstruction (paper, 3.4; Kazhdan and Hoppe 2013): the B-spline chi that minimises
/// int |grad chi + N|^2 + sum_s w_s (chi(p_s) - 1/2)^2, where N is the samples' smeared outward normal field and w_s
/// grows with the sample's share of the surface and its confidence. Zero on the box's border.
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
