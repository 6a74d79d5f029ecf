// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>

#include "isosurface/isosurface.hpp"
#include "poisson/indicator.hpp"

namespace rhizodont {

/// How `guiding_surface` works. The defaults are the product's.
struct GuidingSurfaceOptions {
  IndicatorOptions indicator;
  IsosurfaceOptions isosurface;  ///< `as_ball` is always on
  int smearings = 3;  ///< >= 1: how often the normals are smeared wider to close tunnels, twice by area each time
};

/// A surface like that of a ball, and the function it was taken from.
struct GuidingSurface {
  IndicatorFunction indicator;
  Isosurface surface;           ///< Euler number 2
  double samples_per_cell = 0;  ///< with which it was found
};

/// The guiding surface of a tooth (paper, 3.4): screened Poisson reconstruction of the samples, meshed by GradNormal.
/// Where roots all but touch, the tiling may see narrow tunnels or bridges between them; these are closed or cut. Wide
/// tunnels come from sparse samples, which are then smeared wider.
///
/// \param seeds  as for `grad_normal`; empty means all samples
/// Other parameters and errors as for `solve_indicator` and `grad_normal`.
/// \throws NoResultError  also if the surface has wide tunnels whatever is tried
GuidingSurface guiding_surface(const OrientedPoints& samples, std::span<const double> weights,
                               std::span<const Point> seeds, const GuidingSurfaceOptions& options = {});

}  // namespace rhizodont
