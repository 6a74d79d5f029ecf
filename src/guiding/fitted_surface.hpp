// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "guiding/crown_fit.hpp"
#include "guiding/guiding_cloud.hpp"
#include "rhizodont/mesh.hpp"

namespace rhizodont {

/// The surface that crown and root are joined on.
struct FittedSurface {
  TriangleMesh mesh;
  CrownFit fit;
};

/// The guiding surface M (paper, 3.5): indicator function of the cloud, meshed by GradNormal with cells of edge e (mm),
/// and drawn onto the crown. Throws what `guiding_surface` and `fit_to_crown` throw.
FittedSurface fitted_guiding_surface(const GuidingCloud& cloud, const PreparedCrown& crown, double e);

}  // namespace rhizodont
