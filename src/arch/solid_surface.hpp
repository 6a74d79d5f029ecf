// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "arch/triangle_approach.hpp"
#include "mesh/box_tree.hpp"
#include "rhizodont/mesh.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace rhizodont {

/// How deep in a solid, or how far from it, a point lies.
struct SignedDistance {
  double mm = 0;            ///< distance from the surface; negative inside
  Point on_surface;         ///< the nearest point of the surface
  int triangle = -1;        ///< that holds it; one of them if several do
  std::uint32_t parts = 0;  ///< bit k: part k of the surface comes as near as any (within 1e-9 mm)
};

/// A closed solid's surface in parts, prepared for questions of distance. Owns what it needs; questions may be asked
/// from several threads, and answers do not depend on their number.
class SolidSurface {
 public:
  /// @param mesh              closed, outward, in one piece, mm; not meeting itself. Triangles whose corners lie on one
  ///                          line are left out: their neighbours cover them. Unused vertices are allowed.
  /// @param part_of_triangle  0 to part_count - 1 each; parts may be empty
  /// @param part_count        1 to 32
  /// Throws InputError for a mesh without triangles with area, one that is not closed with its triangles turned alike,
  /// or with non-finite vertices or indices out of range; UsageError for parts that do not fit it.
  SolidSurface(TriangleMesh mesh, std::vector<int> part_of_triangle, int part_count);

  const TriangleMesh& mesh() const { return mesh_; }
  int part_count() const { return static_cast<int>(parts_.size()); }
  int part_of(int triangle) const { return part_of_triangle_[static_cast<std::size_t>(triangle)]; }
  /// Bits of the parts that vertex v is a corner of.
  std::uint32_t parts_of_vertex(std::size_t v) const { return parts_of_vertex_[v]; }
  Corners corners(int triangle) const;
  /// What each corner counts in a point of the triangle's plane; they add to 1.
  std::array<double, 3> barycentric(int triangle, const Point& p) const;
  const ClosedBox& box() const { return box_; }

  /// The signed distance of a point (finite) from the surface; nothing for a point outside that is not nearer than
  /// `within` (mm). Inside or outside is read off the normal at the nearest point: J. A. Baerentzen and H. Aanaes,
  /// "Signed distance computation using the angle weighted pseudonormal", 2005.
  std::optional<SignedDistance> signed_distance(const Point& p,
                                                double within = std::numeric_limits<double>::infinity()) const;

  /// Triangles of one part in a tree; its numbers count `triangles`.
  struct Part {
    std::vector<int> triangles;
    BoxTree tree{{}};
  };
  const Part& part(int k) const { return parts_[static_cast<std::size_t>(k)]; }

 private:
  Eigen::Vector3d normal_at(int triangle, const Point& p) const;

  TriangleMesh mesh_;
  std::vector<int> part_of_triangle_;
  std::vector<std::uint32_t> parts_of_vertex_;
  std::vector<std::array<int, 3>> neighbours_;
  std::vector<Eigen::Vector3d> triangle_normals_, vertex_normals_;
  std::vector<Part> parts_;
  ClosedBox box_{};
};

}  // namespace rhizodont
