// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "networks/surface_sample.hpp"
#include "rhizodont/mesh.hpp"

namespace rhizodont {

/// What the skirt network looks at. Positions: axis from the crown's border +z, centre the area's centroid, unit 6 mm,
/// any turn about z; distances and curvatures in mm; operators and signatures free of size.
/// Precondition: one piece, open, in mm. Fewer eigenvectors come where the crown has few vertices.
/// Throws InputError where the operators or the axis do not exist.
SurfaceSample skirt_features(const TriangleMesh& crown, int eigenvectors);

}  // namespace rhizodont
