// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

#include <Eigen/Geometry>

#include <array>
#include <utility>
#include <vector>

namespace rhizodont {

/// Half the cross product of two edges: length = area (mm^2), direction = outward normal.
Eigen::Vector3d triangle_area_vector(const TriangleMesh& mesh, std::size_t triangle);

/// Area in mm^2.
double triangle_area(const TriangleMesh& mesh, std::size_t triangle);

/// Unit outward normal; the zero vector for a triangle without area.
Eigen::Vector3d triangle_normal(const TriangleMesh& mesh, std::size_t triangle);

/// Interior angles in radians, [0, pi], at corners 0, 1, 2 (0 at a corner with an edge of no length).
std::array<double, 3> triangle_angles(const TriangleMesh& mesh, std::size_t triangle);

/// Sum of the triangles' area vectors (mm^2). It depends on the border alone: zero for a closed mesh; for an open crown
/// it points from the root to the crown.
Eigen::Vector3d area_vector(const TriangleMesh& mesh);

/// Signed volume in mm^3, positive for a closed mesh oriented outward. Of an open mesh: the volume of the cone over
/// it from the centre of its bounding box (meaningless as a volume).
double volume(const TriangleMesh& mesh);

/// Volume in mm^3 between an open mesh and the mean of its border vertices, positive where the triangles face away from
/// it; of a closed mesh, its volume.
double cone_volume(const TriangleMesh& mesh);

/// Surface area in mm^2.
double surface_area(const TriangleMesh& mesh);

/// Unit normals at vertices: triangle normals weighted by the corner's angle (Thuermer and Wuethrich 1998).
/// The zero vector where a vertex has no triangle with area.
std::vector<Eigen::Vector3d> vertex_normals(const TriangleMesh& mesh);

/// Those at some vertices alone, in their order: the very numbers that `vertex_normals` gives, for less.
std::vector<Eigen::Vector3d> vertex_normals_at(const TriangleMesh& mesh, const std::vector<int>& vertices);

/// Empty box for no points.
Eigen::AlignedBox3d bounding_box(const std::vector<Point>& points);

/// Least and largest place of points along an axis; the largest double and the least for none.
std::pair<double, double> extent_along(const std::vector<Point>& points, const Eigen::Vector3d& axis);

/// Mean length of the undirected edges in mm; 0 for a mesh without triangles.
double mean_edge_length(const TriangleMesh& mesh);

/// Area-weighted centroid of the surface. Throws InputError if the mesh has no area.
Point area_centroid(const TriangleMesh& mesh);

}  // namespace rhizodont
