// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fusion/restore.hpp"

namespace rhizodont {

struct RemeshBandOptions {
  double band = 3.0;   ///< mm, >= 0: new triangles within this distance of the crown's border are remeshed
  int iterations = 5;  ///< >= 0
};

/// Improves the new triangles beside the crown's border by isotropic remeshing (CGAL: M. Botsch and L. Kobbelt, "A
/// remeshing approach to multiresolution modeling", 2004). The target edge length lies between the border's and the
/// root's. Crown vertices and triangles stay the first of the mesh, as they were; the border is not split.
/// Throws NoResultError if the result is not an oriented manifold.
void remesh_band(RestoredTooth& tooth, const RemeshBandOptions& options = {});

}  // namespace rhizodont
