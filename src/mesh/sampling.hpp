// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

#include <cstdint>
#include <vector>

namespace rhizodont {

struct SurfaceSamples {
  std::vector<Point> points;
  std::vector<Eigen::Vector3d> normals;  ///< unit, of the triangle
  std::vector<int> triangles;            ///< that each point lies on
};

/// `count` independent points, uniform over the area; the same for the same mesh and seed on every machine.
/// Throws InputError for a mesh without area.
SurfaceSamples sample_surface(const TriangleMesh& mesh, std::size_t count, std::uint64_t seed);

/// Indices of `count` points, each the farthest from those before it; the first is the farthest from the centroid; ties
/// go to the lexicographically smallest (x, y, z). The points chosen do not depend on the order in which they are
/// given. O(points x count). Throws UsageError if count > points, InputError for a non-finite point.
std::vector<int> farthest_point_sampling(const std::vector<Point>& points, std::size_t count);

}  // namespace rhizodont
