// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// "Completing Dental Models While Preserving Crown Geometry and Meshing Topology", section 3.4.
#include "guiding/guiding_surface.hpp"

#include "base/option_range.hpp"
#include "rhizodont/error.hpp"

namespace rhizodont {

GuidingSurface guiding_surface(const OrientedPoints& samples, std::span<const double> weights,
                               std::span<const Point> seeds, const GuidingSurfaceOptions& options) {
  require_ranges("the guiding surface", {{"smearings", options.smearings, OptionRange::at_least(1)}});
  require_in_range(options.indicator);
  require_in_range(options.isosurface);
  const std::span<const Point> start = seeds.empty() ? std::span<const Point>(samples.points) : seeds;
  IndicatorOptions indicator = options.indicator;
  IsosurfaceOptions isosurface = options.isosurface;
  isosurface.as_ball = true;
  for (int smearing = 1;; ++smearing, indicator.samples_per_cell *= 2.0) {
    IndicatorFunction chi = solve_indicator(samples, weights, indicator);
    const ScalarField field = [&chi](const Point& p) { return chi.evaluate(p); };
    try {
      Isosurface surface = grad_normal(field, chi.iso_value(), start, isosurface);
      return {std::move(chi), std::move(surface), indicator.samples_per_cell};
    } catch (const NoResultError&) {
      if (smearing == options.smearings) throw;
    }
  }
}

}  // namespace rhizodont
