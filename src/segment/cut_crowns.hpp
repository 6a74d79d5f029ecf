// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "mesh/adjacency.hpp"
#include "rhizodont/mesh.hpp"

#include <map>
#include <vector>

namespace rhizodont {

/// The crowns of a scan by their numbers, each the triangles whose corners all bear its number; 0 is gum. Vertices keep
/// their bits and order. Teeth without such a triangle are left out. @param labels  per vertex of the scan. Throws
/// InputError for labels of another length.
std::map<int, Submesh> cut_crowns(const TriangleMesh& scan, const std::vector<int>& labels);

/// What is left of the scan beside its teeth: triangles with a corner of gum or with corners of several teeth.
TriangleMesh gum_of(const TriangleMesh& scan, const std::vector<int>& labels);

}  // namespace rhizodont
