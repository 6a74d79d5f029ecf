// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "mesh/diagnosis.hpp"
#include "rhizodont/mesh.hpp"

namespace rhizodont {

/// Refuses meshes that cannot be looked at: no triangles, indices out of range or repeated in a triangle, coordinates
/// that are not finite. Throws InputError (ids of vertices or triangles). Returns what was found out.
Diagnosis require_readable_crown(const TriangleMesh& crown);

/// Refuses meshes that no tooth can be made of, with a sentence that says what is wrong and where: no triangles,
/// indices out of range, coordinates that are not finite, edges with more than two triangles, triangles turned against
/// their neighbours, several pieces. Throws InputError (ids of vertices or triangles). Returns what was found out.
Diagnosis require_usable_crown(const TriangleMesh& crown);

/// Refuses pieces of like size: several crowns, or one in halves. Smaller pieces may be there. Throws InputError.
/// Precondition: readable.
void require_one_crown(const TriangleMesh& crown);

/// Refuses a crown that is not between 2 and 20 mm across, with a hint at the unit it may have; `millimetres_per_unit`
/// is what the coordinates were already multiplied with. A closed one may be up to 45 mm long: there may be a plinth or
/// a root. Throws InputError.
void require_tooth_size(const TriangleMesh& crown, double millimetres_per_unit, bool closed = false);

/// Refuses a closed mesh, of which no cap was recognised, that is longer than crowns are: a whole tooth. Throws
/// InputError.
void require_no_root(const TriangleMesh& closed_crown);

/// Refuses an open crown whose triangles face inwards, that has handles, that is open towards the root in more than one
/// place, or that cuts itself. Throws InputError (ids of vertices or triangles). Precondition: one piece, its border
/// made of simple loops.
void require_outward_and_uncut(const TriangleMesh& open_crown);

}  // namespace rhizodont
