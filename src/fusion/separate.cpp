// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// "Completing Dental Models While Preserving Crown Geometry and Meshing Topology", section 3.6: separation between the
//   crown and the root. There every crown vertex within epsilon must lie above the vertex; on occlusal surfaces, which
//   lie across the growth axis, that test depends on which side of the crown the guiding surface happens to run. The
//   closest point being on the border says the same without the axis.

#include "fusion/separate.hpp"

#include "fusion/crown_border.hpp"
#include "mesh/closest_point.hpp"
#include "rhizodont/error.hpp"

#include <algorithm>

namespace rhizodont {
namespace {

/// Keeps the vertices connected to `seed` through edges between marked vertices; returns how many were unmarked.
int keep_connected(const TriangleMesh& surface, int seed, std::vector<bool>& marked) {
  std::vector<std::vector<int>> around(surface.vertices.size());
  for (const Triangle& t : surface.triangles)
    for (std::size_t i = 0; i < 3; ++i) around[static_cast<std::size_t>(t[i])].push_back(t[(i + 1) % 3]);
  std::vector<bool> reached(surface.vertices.size(), false);
  std::vector<int> stack{seed};
  reached[static_cast<std::size_t>(seed)] = true;
  while (!stack.empty()) {
    const int v = stack.back();
    stack.pop_back();
    for (const int w : around[static_cast<std::size_t>(v)]) {
      if (reached[static_cast<std::size_t>(w)] || !marked[static_cast<std::size_t>(w)]) continue;
      reached[static_cast<std::size_t>(w)] = true;
      stack.push_back(w);
    }
  }
  int dropped = 0;
  for (std::size_t v = 0; v < marked.size(); ++v) {
    if (!marked[v] || reached[v]) continue;
    marked[v] = false;
    ++dropped;
  }
  return dropped;
}

}  // namespace

Separation separate_crown_and_root(const TriangleMesh& guiding_surface, const TriangleMesh& crown,
                                   const Eigen::Vector3d& growth_axis, const SeparationOptions& options) {
  const CrownBorder border = find_crown_border(crown);
  const ClosestPointIndex index(crown);
  const double clearance = options.clearance * border.mean_edge;
  Separation result;
  result.is_root.resize(guiding_surface.vertices.size());
  int lowest = -1;
  double lowest_height = 0;
  for (std::size_t v = 0; v < guiding_surface.vertices.size(); ++v) {
    const Point& p = guiding_surface.vertices[v];
    const ClosestPoint closest = index.closest(p);
    const bool beyond_border = closest.distance > clearance && lies_on_border(crown, border, closest);
    result.is_root[v] = closest.distance > options.epsilon || beyond_border;
    if (!result.is_root[v]) continue;
    const double height = p.dot(growth_axis);
    if (lowest >= 0 && height >= lowest_height) continue;
    lowest = static_cast<int>(v);
    lowest_height = height;
  }
  if (lowest < 0) throw NoResultError("No root was found: the predicted tooth does not reach beyond the crown.");
  result.islands_dropped = keep_connected(guiding_surface, lowest, result.is_root);
  result.root_vertices = static_cast<int>(std::count(result.is_root.begin(), result.is_root.end(), true));
  return result;
}

}  // namespace rhizodont
