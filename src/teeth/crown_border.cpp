// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "teeth/crown_border.hpp"

#include "mesh/adjacency.hpp"
#include "mesh/geometry.hpp"
#include "rhizodont/error.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace rhizodont {
namespace {

/// Smallest angle in degrees between consecutive border edges where the crown takes up more than half a turn.
double sharpest_notch(const TriangleMesh& crown, const CrownBorder& border) {
  constexpr double degrees = 180 / std::numbers::pi;
  std::vector<double> turn(crown.vertices.size(), 0);
  for (std::size_t t = 0; t < crown.triangles.size(); ++t) {
    const auto angles = triangle_angles(crown, t);
    for (std::size_t i = 0; i < 3; ++i) turn[static_cast<std::size_t>(crown.triangles[t][i])] += angles[i] * degrees;
  }
  std::vector<int> before(crown.vertices.size(), -1);
  for (const auto& [from, to] : border.half_edges) before[static_cast<std::size_t>(to)] = from;
  double sharpest = 180;
  for (const auto& [v, next] : border.half_edges) {
    const int previous = before[static_cast<std::size_t>(v)];
    if (turn[static_cast<std::size_t>(v)] <= 180 || previous < 0) continue;
    const Eigen::Vector3d a =
        crown.vertices[static_cast<std::size_t>(previous)] - crown.vertices[static_cast<std::size_t>(v)];
    const Eigen::Vector3d b =
        crown.vertices[static_cast<std::size_t>(next)] - crown.vertices[static_cast<std::size_t>(v)];
    sharpest = std::min(sharpest, std::atan2(a.cross(b).norm(), a.dot(b)) * degrees);
  }
  return sharpest;
}

}  // namespace

CrownBorder find_crown_border(const TriangleMesh& crown) {
  CrownBorder border;
  border.is_vertex.assign(crown.vertices.size(), false);
  border.is_edge.assign(crown.triangles.size(), {false, false, false});
  const EdgeTable table = edge_table(crown);
  for (std::size_t e = 0; e < table.size(); ++e) {
    if (table.triangle_count(e) != 1) continue;
    const int h = table.half_edges[static_cast<std::size_t>(table.first[e])];
    const int a = half_edge_from(crown, h), b = half_edge_to(crown, h);
    border.half_edges.emplace_back(a, b);
    border.is_edge[static_cast<std::size_t>(h / 3)][static_cast<std::size_t>(h % 3)] = true;
    border.is_vertex[static_cast<std::size_t>(a)] = border.is_vertex[static_cast<std::size_t>(b)] = true;
    border.mean_edge +=
        (crown.vertices[static_cast<std::size_t>(a)] - crown.vertices[static_cast<std::size_t>(b)]).norm();
  }
  if (border.half_edges.empty())
    throw InputError("The crown is closed: without an open base there is no place for a root.");
  border.mean_edge /= static_cast<double>(border.half_edges.size());
  border.sharpest_notch = sharpest_notch(crown, border);
  return border;
}

}  // namespace rhizodont
