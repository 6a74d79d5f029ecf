// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// S. Katz and A. Tal, "Hierarchical mesh decomposition using fuzzy clustering and cuts", ACM Transactions on Graphics
//   22(3), 2003: boundaries between regions of a mesh as minimum cuts along bent edges.

#include "skirt/cap.hpp"

#include "base/minimum_cut.hpp"
#include "base/option_range.hpp"
#include "mesh/adjacency.hpp"
#include "mesh/geometry.hpp"
#include "mesh/nearest_vertex.hpp"
#include "rhizodont/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace rhizodont {
namespace {

constexpr const char* no_cap_sentence =
    "The mesh is closed, and no cap over a crown's base was recognised: give the crown with its base open.";

std::vector<bool> cut_off_cap(const TriangleMesh& mesh, const Eigen::Vector3d& axis, const CapOptions& options) {
  const TriangleAdjacency adjacency = triangle_adjacency(mesh);
  const std::size_t n = mesh.triangles.size();
  std::vector<double> cost_cap(n), cost_crown(n);
  std::vector<CutEdge> edges;
  const double sharp = options.ridge_angle * std::numbers::pi / 180;
  for (std::size_t t = 0; t < n; ++t) {
    const double area = triangle_area(mesh, t);
    const double facing = -triangle_normal(mesh, t).dot(axis) - options.facing;
    cost_crown[t] = area * std::max(facing, 0.0);
    cost_cap[t] = area * std::max(-facing, 0.0);
    for (std::size_t e = 0; e < 3; ++e) {
      const int other = adjacency.neighbours[t][e];
      if (other < static_cast<int>(t)) continue;
      const Point& a = mesh.vertices[static_cast<std::size_t>(mesh.triangles[t][e])];
      const Point& b = mesh.vertices[static_cast<std::size_t>(mesh.triangles[t][(e + 1) % 3])];
      const Eigen::Vector3d here = triangle_normal(mesh, t);
      const Eigen::Vector3d there = triangle_normal(mesh, static_cast<std::size_t>(other));
      const double turn = std::atan2(here.cross(there).dot((b - a).normalized()), here.dot(there));  // > 0: convex
      const double ridge = std::max(turn, 0.0) / sharp;
      edges.push_back({static_cast<int>(t), other, (b - a).norm() * (0.05 + std::exp(-ridge * ridge))});
    }
  }
  return minimum_cut(cost_cap, cost_crown, edges);
}

/// Leaves only the largest region of the given side, and gives everything it encloses to that side.
void keep_one_region(const TriangleMesh& mesh, std::vector<bool>& side, bool value) {
  const TriangleAdjacency adjacency = triangle_adjacency(mesh);
  std::vector<int> region(side.size(), -1);
  std::vector<double> area;
  std::vector<int> stack;
  for (std::size_t seed = 0; seed < side.size(); ++seed) {
    if (side[seed] != value || region[seed] >= 0) continue;
    const int id = static_cast<int>(area.size());
    area.push_back(0);
    region[seed] = id;
    stack.push_back(static_cast<int>(seed));
    while (!stack.empty()) {
      const auto t = static_cast<std::size_t>(stack.back());
      stack.pop_back();
      area[static_cast<std::size_t>(id)] += triangle_area(mesh, t);
      for (const int o : adjacency.neighbours[t]) {
        if (o < 0 || region[static_cast<std::size_t>(o)] >= 0 || side[static_cast<std::size_t>(o)] != value) continue;
        region[static_cast<std::size_t>(o)] = id;
        stack.push_back(o);
      }
    }
  }
  if (area.empty()) return;
  const int largest = static_cast<int>(std::max_element(area.begin(), area.end()) - area.begin());
  for (std::size_t t = 0; t < side.size(); ++t)
    if (side[t] == value && region[t] != largest) side[t] = !value;
}

/// Mean angle, over the rim, between the surface's directions on both sides of it, each averaged over about a
/// millimetre.
double rim_bend(const TriangleMesh& mesh, const std::vector<bool>& is_cap) {
  constexpr double width = 1.2;  // mm
  std::vector<Point> centres;
  for (const auto& [a, b, c] : mesh.triangles)
    centres.push_back((mesh.vertices[static_cast<std::size_t>(a)] + mesh.vertices[static_cast<std::size_t>(b)] +
                       mesh.vertices[static_cast<std::size_t>(c)]) /
                      3);
  const NearestVertexIndex index(centres);
  const TriangleAdjacency adjacency = triangle_adjacency(mesh);
  double sum = 0;
  double length = 0;
  for (std::size_t t = 0; t < is_cap.size(); ++t) {
    for (std::size_t e = 0; e < 3; ++e) {
      const int other = adjacency.neighbours[t][e];
      if (!is_cap[t] || other < 0 || is_cap[static_cast<std::size_t>(other)]) continue;
      const Point& a = mesh.vertices[static_cast<std::size_t>(mesh.triangles[t][e])];
      const Point& b = mesh.vertices[static_cast<std::size_t>(mesh.triangles[t][(e + 1) % 3])];
      Eigen::Vector3d cap_side = Eigen::Vector3d::Zero();
      Eigen::Vector3d crown_side = Eigen::Vector3d::Zero();
      for (const NearVertex& near : index.within(0.5 * (a + b), width)) {
        const auto i = static_cast<std::size_t>(near.index);
        (is_cap[i] ? cap_side : crown_side) += triangle_area_vector(mesh, i);
      }
      const double angle = std::atan2(cap_side.cross(crown_side).norm(), cap_side.dot(crown_side));
      sum += (b - a).norm() * angle;
      length += (b - a).norm();
    }
  }
  return length > 0 ? sum / length * 180 / std::numbers::pi : 0;
}

/// Mean bend per length of the part of the cap that lies across its direction, away from the rounded rim.
double inner_curvature(const TriangleMesh& mesh, const Cap& cap) {
  const TriangleAdjacency adjacency = triangle_adjacency(mesh);
  double bend = 0;
  double area = 0;
  for (std::size_t t = 0; t < cap.is_cap.size(); ++t) {
    const Eigen::Vector3d here = triangle_normal(mesh, t);
    if (!cap.is_cap[t] || here.dot(cap.direction) < 0.7) continue;
    area += triangle_area(mesh, t);
    for (std::size_t e = 0; e < 3; ++e) {
      const int other = adjacency.neighbours[t][e];
      if (other < static_cast<int>(t) || !cap.is_cap[static_cast<std::size_t>(other)]) continue;
      const Eigen::Vector3d there = triangle_normal(mesh, static_cast<std::size_t>(other));
      const Point& a = mesh.vertices[static_cast<std::size_t>(mesh.triangles[t][e])];
      const Point& b = mesh.vertices[static_cast<std::size_t>(mesh.triangles[t][(e + 1) % 3])];
      bend += (b - a).norm() * std::atan2(here.cross(there).norm(), here.dot(there));
    }
  }
  return area > 0 ? bend / area : 0;
}

/// How far the cap's centroid lies behind the middle of its rim, along the axis.
double depth_behind_rim(const TriangleMesh& mesh, const std::vector<bool>& is_cap, const Eigen::Vector3d& axis) {
  const TriangleAdjacency adjacency = triangle_adjacency(mesh);
  double area = 0, length = 0, inner = 0, rim = 0;
  for (std::size_t t = 0; t < is_cap.size(); ++t) {
    if (!is_cap[t]) continue;
    double height = 0;
    for (std::size_t e = 0; e < 3; ++e) {
      const Point& a = mesh.vertices[static_cast<std::size_t>(mesh.triangles[t][e])];
      const Point& b = mesh.vertices[static_cast<std::size_t>(mesh.triangles[t][(e + 1) % 3])];
      height += a.dot(axis) / 3;
      const int other = adjacency.neighbours[t][e];
      if (other < 0 || is_cap[static_cast<std::size_t>(other)]) continue;
      length += (b - a).norm();
      rim += (b - a).norm() * 0.5 * (a + b).dot(axis);
    }
    area += triangle_area(mesh, t);
    inner += triangle_area(mesh, t) * height;
  }
  return area > 0 && length > 0 ? inner / area - rim / length : 0;
}

void require_in_range(const CapOptions& options) {
  require_ranges("a cap", {{"facing", options.facing, OptionRange::above(-1).below(1)},
                           {"ridge_angle", options.ridge_angle, OptionRange::above(0)},
                           {"least_flatness", options.least_flatness, share_range},
                           {"least_rim", options.least_rim, OptionRange::at_least(0)},
                           {"least_share", options.least_share, share_range}});
}

}  // namespace

double outline_area(const TriangleMesh& mesh, const Eigen::Vector3d& axis) {
  const Eigen::Vector3d u = axis.unitOrthogonal();
  const Eigen::Vector3d v = axis.cross(u);
  std::vector<std::pair<double, double>> points;
  for (const Point& p : mesh.vertices) points.emplace_back(p.dot(u), p.dot(v));
  std::sort(points.begin(), points.end());
  const auto turns_left = [](const auto& a, const auto& b, const auto& c) {
    return (b.first - a.first) * (c.second - a.second) - (b.second - a.second) * (c.first - a.first) > 0;
  };
  // Monotone chain (Andrew 1979): lower outline forwards, upper outline backwards.
  std::vector<std::pair<double, double>> hull;
  const auto extend = [&](const auto& p, std::size_t keep) {
    while (hull.size() > keep && !turns_left(hull[hull.size() - 2], hull.back(), p)) hull.pop_back();
    hull.push_back(p);
  };
  for (const auto& p : points) extend(p, 1);
  const std::size_t lower = hull.size();
  for (auto it = points.rbegin() + 1; it != points.rend(); ++it) extend(*it, lower);
  double twice = 0;
  for (std::size_t i = 0; i + 1 < hull.size(); ++i)
    twice += hull[i].first * hull[i + 1].second - hull[i].second * hull[i + 1].first;
  return 0.5 * twice;
}

Cap describe_cap(const TriangleMesh& closed_crown, std::vector<bool> is_cap, const Eigen::Vector3d& growth_axis) {
  Cap cap;
  cap.is_cap = std::move(is_cap);
  Eigen::Vector3d vector = Eigen::Vector3d::Zero();
  double area = 0;
  for (std::size_t t = 0; t < cap.is_cap.size(); ++t) {
    if (!cap.is_cap[t]) continue;
    ++cap.triangles;
    area += triangle_area(closed_crown, t);
    vector += triangle_area_vector(closed_crown, t);
  }
  if (cap.triangles == 0 || cap.triangles == static_cast<int>(cap.is_cap.size()) || !(vector.norm() > 0))
    throw InputError(no_cap_sentence);
  cap.direction = vector.normalized();
  cap.flatness = vector.norm() / area;
  cap.share = -vector.dot(growth_axis) / outline_area(closed_crown, growth_axis);
  cap.rim = rim_bend(closed_crown, cap.is_cap);
  cap.depth = depth_behind_rim(closed_crown, cap.is_cap, growth_axis);
  cap.curvature = inner_curvature(closed_crown, cap);
  return cap;
}

Cap find_cap(const TriangleMesh& closed_crown, const Eigen::Vector3d& growth_axis, const CapOptions& options) {
  require_in_range(options);
  std::vector<bool> is_cap = cut_off_cap(closed_crown, growth_axis, options);
  keep_one_region(closed_crown, is_cap, true);
  keep_one_region(closed_crown, is_cap, false);
  return describe_cap(closed_crown, std::move(is_cap), growth_axis);
}

void require_cap(const Cap& cap, const CapOptions& options) {
  require_in_range(options);
  if (cap.flatness >= options.least_flatness && cap.share >= options.least_share && cap.rim >= options.least_rim)
    return;
  constexpr double hollow = 0.7;  // mm
  const char* reason = cap.depth > hollow ? "what faces the root is hollow, as the inside of a restoration"
                       : cap.share < options.least_share ? "what faces the root is narrower than a base"
                       : cap.rim < options.least_rim     ? "what faces the root runs into the crown without an edge"
                                                         : "what faces the root is not flat enough for a cap";
  throw InputError(fmt::format("{} ({}.)", no_cap_sentence, reason));
}

}  // namespace rhizodont
