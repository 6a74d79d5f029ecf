// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

namespace rhizodont {

/// How a library of meshes closes a crown: its border is triangulated, refined and faired (CGAL; P. Liepa 2003).
/// Precondition: an oriented manifold. Throws NoResultError where it is none, or a border is not closed.
TriangleMesh cgal_filled(const TriangleMesh& crown);

/// How a program with a tooth library joins: the crown, closed by triangles over its border, united with the part of a
/// fitted whole tooth that lies below `overlap_mm` above the middle of the crown's border (CGAL's corefinement).
/// Throws NoResultError where either cannot be closed or the union is no manifold.
TriangleMesh cgal_united(const TriangleMesh& crown, const TriangleMesh& fitted_tooth, double overlap_mm = 1.0);

/// A closed mesh in triangles with edges of about `edge_mm` (CGAL; M. Botsch and L. Kobbelt 2004), so many rounds.
TriangleMesh cgal_remeshed(const TriangleMesh& mesh, double edge_mm, unsigned rounds = 5);

}  // namespace rhizodont
