// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Projection of vertices on lattice edges to an implicit surface. The field is no distance and may be flat half an edge
// away from the surface, so each search starts at the crossing with the edge, which is always there, and slides from it
// along the surface to the point nearest to the edge's midpoint.
#include "isosurface/projection.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <cmath>
#include <optional>

namespace rhizodont {
namespace {

/// The point of the surface nearest to `target`, by sliding along tangent planes from a point on the surface.
std::optional<Point> nearest_on_surface(const ScalarField& field, double iso, const Point& target, const Point& start,
                                        const IsosurfaceOptions& options) {
  Point p = start;
  const double largest_step = 0.3 * options.e;
  for (int step = 0; step < 5; ++step) {
    const FieldSample sample = field(p);
    const double squared = sample.gradient.squaredNorm();
    if (!(squared > 0.0)) return std::nullopt;
    const Eigen::Vector3d away = target - p;
    Eigen::Vector3d slide = away - away.dot(sample.gradient) / squared * sample.gradient;
    const double length = slide.norm();
    if (!std::isfinite(length)) return std::nullopt;
    if (length < 1e-3 * options.e) break;
    if (length > largest_step) slide *= largest_step / length;
    const auto settled = settle(field, iso, p + slide, largest_step, 1e-3 * options.e);
    if (!settled) return std::nullopt;
    p = *settled;
  }
  return settle(field, iso, p, largest_step, options.tolerance);
}

}  // namespace

std::optional<Point> crossing_of_edge(const ScalarField& field, double iso, const Point& inside, const Point& outside,
                                      double tolerance) {
  const Eigen::Vector3d edge = outside - inside;
  const double length = edge.norm(), at_inside = field(inside).value - iso, at_outside = field(outside).value - iso;
  if (at_inside > 0.0 && at_outside == 0.0) return outside;
  if (!(at_inside > 0.0) || !(at_outside < 0.0)) return std::nullopt;
  double low = 0.0, high = 1.0, t = at_inside / (at_inside - at_outside);
  for (int step = 0; step < 100; ++step) {
    const FieldSample sample = field(inside + t * edge);
    const double value = sample.value - iso, slope = sample.gradient.dot(edge);
    if (value == 0.0) break;
    (value > 0.0 ? low : high) = t;
    double next = t - value / slope;
    // Every fourth step halves the bracket, so that the search ends whatever the field.
    if (step % 4 == 3 || !(next > low && next < high)) next = 0.5 * (low + high);
    const double moved = std::abs(next - t) * length;
    t = next;
    if (moved < tolerance || !(t > low && t < high)) break;
  }
  return inside + t * edge;
}

std::optional<Point> settle(const ScalarField& field, double iso, Point p, double largest_step, double tolerance) {
  for (int step = 0; step < 12; ++step) {
    const FieldSample sample = field(p);
    const double squared = sample.gradient.squaredNorm();
    if (!(squared > 0.0)) return std::nullopt;
    const Eigen::Vector3d move = (iso - sample.value) / squared * sample.gradient;
    const double length = move.norm();
    if (!std::isfinite(length)) return std::nullopt;
    p += length > largest_step ? Eigen::Vector3d(largest_step / length * move) : move;
    if (length < 0.1 * tolerance) return p;
  }
  return std::nullopt;
}

Eigen::Vector3d outward_normal(const ScalarField& field, const Point& p) {
  const Eigen::Vector3d gradient = field(p).gradient;
  const double length = gradient.norm();
  return length > 0.0 && std::isfinite(length) ? Eigen::Vector3d(-gradient / length) : Eigen::Vector3d::Zero();
}

void project_vertices(const ScalarField& field, double iso, const IsosurfaceOptions& options,
                      std::vector<EdgeVertex>& vertices) {
  tbb::parallel_for(std::size_t{0}, vertices.size(), [&](std::size_t i) {
    EdgeVertex& vertex = vertices[i];
    const Point middle = 0.5 * (vertex.inside + vertex.outside);
    const auto crossing = crossing_of_edge(field, iso, vertex.inside, vertex.outside, 0.1 * options.tolerance);
    vertex.crossing = crossing.value_or(middle);
    if (!crossing) {
      vertex.position = middle;
      vertex.normal = (vertex.outside - vertex.inside).normalized();
      return;
    }
    const auto nearest = nearest_on_surface(field, iso, middle, vertex.crossing, options);
    const bool near = nearest && (*nearest - middle).norm() <= options.max_displacement * options.e;
    vertex.position = near ? *nearest : vertex.crossing;
    vertex.normal = outward_normal(field, vertex.position);
    vertex.on_surface = true;
  });
}

std::size_t restrain_flipped(std::vector<EdgeVertex>& vertices, const std::vector<Triangle>& triangles,
                             const ScalarField& field) {
  std::size_t moved = 0;
  for (int round = 0; round < 4; ++round) {
    std::vector<char> back(vertices.size(), 0);
    bool any = false;
    for (const Triangle& triangle : triangles) {
      const EdgeVertex& a = vertices[static_cast<std::size_t>(triangle[0])];
      const EdgeVertex& b = vertices[static_cast<std::size_t>(triangle[1])];
      const EdgeVertex& c = vertices[static_cast<std::size_t>(triangle[2])];
      const Eigen::Vector3d normal = (b.position - a.position).cross(c.position - a.position);
      if (normal.dot(a.normal + b.normal + c.normal) > 0.0) continue;
      for (const std::int32_t v : triangle) back[static_cast<std::size_t>(v)] = 1;
    }
    for (std::size_t v = 0; v < vertices.size(); ++v) {
      if (!back[v] || vertices[v].position == vertices[v].crossing) continue;
      vertices[v].position = vertices[v].crossing;
      vertices[v].normal = outward_normal(field, vertices[v].position);
      ++moved;
      any = true;
    }
    if (!any) break;
  }
  return moved;
}

}  // namespace rhizodont
