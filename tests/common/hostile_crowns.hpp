// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace rhizodont {
class RandomStream;
}

// Crowns as bad as files hold them, made from a clean crown and a seed.
namespace rhizodont::test {

/// Names of the defects that `hostile_crown` knows, in a fixed order.
std::vector<std::string> hostile_kinds();

/// The clean crown with defects of one kind, or of two to four kinds for "combination". `clean` is an open crown in mm,
/// about 8 mm across. Depends on the arguments alone. Half of the seeds round the coordinates to float.
/// Throws UsageError for an unknown kind.
TriangleMesh hostile_crown(const TriangleMesh& clean, const std::string& kind, std::uint64_t seed);

/// The crown with exactly `vertices` vertices: its longest edges are split, new vertices lie on the curved surface that
/// the vertex normals suggest. No less than it has.
TriangleMesh refined_to(TriangleMesh mesh, std::size_t vertices);

/// The crown with about `vertices` vertices, by edge collapse. No more than it has.
TriangleMesh coarsened_to(const TriangleMesh& mesh, std::size_t vertices);

/// `refined_to` or `coarsened_to`.
TriangleMesh resized_to(const TriangleMesh& mesh, std::size_t vertices);

/// The crown closed by a fan over its base.
TriangleMesh capped(const TriangleMesh& crown);

// What the generators of bad crowns have in common.

/// A unit vector, all directions alike.
Eigen::Vector3d any_direction(RandomStream& random);

/// Half-edges (from, to) of edges with one triangle, as that triangle runs. Of any mesh.
std::vector<std::pair<int, int>> border_half_edges(const TriangleMesh& mesh);

/// Puts a tube in the place of triangles `s` and `t`, bulging outwards by `bulge` mm: a handle. Nothing where the two
/// share a vertex. The tube's vertices become the last.
void add_tube(TriangleMesh& mesh, std::size_t s, std::size_t t, double bulge);

}  // namespace rhizodont::test
