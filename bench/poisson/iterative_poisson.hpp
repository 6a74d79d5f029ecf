// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>

#include "isosurface/isosurface.hpp"
#include "poisson/indicator.hpp"

namespace rhizodont {

/// How `iterative_poisson` works.
struct IterativePoissonOptions {
  IndicatorOptions indicator;
  double e = 0.5;            ///< mm, > 0: size of the tiling from which normals are read
  int neighbours = 10;       ///< >= 1: samples nearest to a triangle that take part of its normal
  int most_iterations = 30;  ///< >= 1
  double still = 0.175;      ///< > 0: stop when the most restless thousandth of the normals change by less
  std::uint64_t seed = 1;    ///< of the random normals at the start
};

/// Points with the normals that came out, and the surface of the last iteration.
struct IterativePoisson {
  OrientedPoints oriented;  ///< unit normals, outward
  TriangleMesh surface;     ///< plain isosurface: all parts, triangles as they come
  int iterations = 0;
  double change = 0;  ///< of the most restless thousandth of the normals in the last iteration
};

/// Iterative Poisson surface reconstruction (Hou, Wang, Wang, Qin, Qian and He 2022; the baseline of the paper's table
/// 5): normals start at random; each iteration solves for the indicator function and reads new normals from the
/// triangles of its isosurface near each sample. Needs no hints, and many solves. Deterministic by seed.
///
/// \throws InputError, UsageError, NoResultError  as `solve_indicator` and `marching_tetrahedra`
IterativePoisson iterative_poisson(std::span<const Point> points, const IterativePoissonOptions& options = {});

}  // namespace rhizodont
