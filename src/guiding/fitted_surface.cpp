// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// "Completing Dental Models While Preserving Crown Geometry and Meshing Topology", section 3.5: the guiding surface.

#include "guiding/fitted_surface.hpp"

#include "guiding/guiding_surface.hpp"

#include <span>
#include <utility>

namespace rhizodont {

FittedSurface fitted_guiding_surface(const GuidingCloud& cloud, const PreparedCrown& crown, double e) {
  GuidingSurfaceOptions options;
  options.isosurface.e = e;
  const std::span<const Point> seeds(cloud.samples.points.data(), static_cast<std::size_t>(cloud.crown_samples));
  FittedSurface result{guiding_surface(cloud.samples, cloud.confidence, seeds, options).surface.mesh, {}};
  CrownFitOptions fit;
  fit.tolerance = 0.015 * e;
  result.fit = fit_to_crown(result.mesh, crown, fit);
  return result;
}

}  // namespace rhizodont
