// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "completion/mean_crowns.hpp"
#include "families/tooth_family.hpp"

namespace rhizodont {

/// What a template may do to come near a scanned crown.
struct CrownFitFreedom {
  bool three_scales = false;  ///< a scale for each axis instead of one for all
  bool modes = false;         ///< the crown model's modes, held by their own deviations
};

/// Points of a real crown's enamel in about the pose of the type's template, left side.
struct CrownPoints {
  std::vector<Point> points;
  std::vector<Eigen::Vector3d> normals;  ///< unit, outward
};

/// Brings a crown that is closed by a cap (arch's frame: y up) near the mean tooth of its type and leaves the cap out.
CrownPoints pose_crown(const ToothFamilies& families, const Atlas& atlas, const TriangleMesh& crown, int fdi);

/// Mean distance in millimetres of the crown's points from the template fitted to them.
double fit_crown(const ToothFamilies& families, int type, const CrownPoints& crown, const CrownFitFreedom& freedom);

}  // namespace rhizodont
