// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

namespace rhizodont {

/// The surface in triangles with edges of about `edge_mm`; two rounds only: they stay as irregular as a scanner's.
/// Source: M. Botsch, L. Kobbelt, "A remeshing approach to multiresolution modeling", 2004 (CGAL).
/// Precondition: an oriented manifold, possibly with borders.
TriangleMesh remeshed(const TriangleMesh& mesh, double edge_mm);

}  // namespace rhizodont
