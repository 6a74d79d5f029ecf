// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include "isosurface/isosurface.hpp"

namespace rhizodont {

/// A vertex on a lattice edge that the surface cuts, and where it goes.
struct EdgeVertex {
  Point inside = Point::Zero();    ///< end of the edge with field > iso
  Point outside = Point::Zero();   ///< other end
  Point crossing = Point::Zero();  ///< of the edge and the surface; the edge's midpoint if there is none
  Point position =
      Point::Zero();  ///< on the surface, the point nearest to the edge's midpoint; the crossing if none is near
  Eigen::Vector3d normal =
      Eigen::Vector3d::Zero();  ///< of the surface at `position`, outward unit; zero where the field has no gradient
  bool on_surface = false;      ///< whether `position` is; not so where a bridge was cut or a tunnel filled
};

/// Where the field takes the value between the ends, by Newton steps within a bracket that bisection narrows. Nothing
/// if the ends are not on their sides, because one was put on the other to cut a bridge or to fill a tunnel.
/// `tolerance` in mm.
std::optional<Point> crossing_of_edge(const ScalarField& field, double iso, const Point& inside, const Point& outside,
                                      double tolerance);

/// Newton steps along the gradient to the surface; nothing if they leave it or the field is flat. `tolerance` in mm.
std::optional<Point> settle(const ScalarField& field, double iso, Point p, double largest_step, double tolerance);

/// Against the gradient, unit; zero where the field is flat.
Eigen::Vector3d outward_normal(const ScalarField& field, const Point& p);

/// Finds crossing, position and normal of each vertex, whose ends are given.
void project_vertices(const ScalarField& field, double iso, const IsosurfaceOptions& options,
                      std::vector<EdgeVertex>& vertices);

/// Moves vertices of triangles that turned over back towards their crossings. Returns how many were moved.
std::size_t restrain_flipped(std::vector<EdgeVertex>& vertices, const std::vector<Triangle>& triangles,
                             const ScalarField& field);

}  // namespace rhizodont
