// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "mesh/adjacency.hpp"
#include "mesh/at.hpp"
#include "mesh/nearest_vertex.hpp"
#include "rhizodont/mesh.hpp"

#include <vector>

namespace rhizodont {

/// A place on a triangle mesh.
struct SurfacePlace {
  Point point = Point::Zero();
  int triangle = -1;
};

/// Projects points that move in small steps to a closed mesh: the search starts at the triangle where the point was and
/// follows the surface downhill, so it is fast, and a point between two sheets stays on its own.
class SurfaceWalk {
 public:
  /// Keeps a reference to `surface`. Throws what `triangle_adjacency` throws, and InputError for an empty surface or a
  /// vertex that is not finite.
  explicit SurfaceWalk(const TriangleMesh& surface);

  /// The locally closest place, searched from triangle `start`.
  SurfacePlace closest(const Point& p, int start) const;

  /// Unit normal of a triangle; zero for one without area.
  const Eigen::Vector3d& normal(int triangle) const { return normals_[static_cast<std::size_t>(triangle)]; }

  const TriangleMesh& surface() const { return surface_; }

  /// A triangle at each vertex.
  int triangle_at(int vertex) const { return around_.triangles[at(around_.first[at(vertex)])]; }

  /// A triangle at the surface's vertex nearest to the point.
  int triangle_near(const Point& p) const { return triangle_at(vertices_.nearest(p).index); }

 private:
  const TriangleMesh& surface_;
  TriangleAdjacency adjacency_;
  VertexTriangles around_;
  NearestVertexIndex vertices_;
  std::vector<Eigen::Vector3d> normals_;
};

}  // namespace rhizodont
