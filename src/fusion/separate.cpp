// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// "Completing Dental Models While Preserving Crown Geometry and Meshing Topology", section 3.6: separation between the
//   crown and the root. There every crown vertex within epsilon must lie above the vertex; on occlusal surfaces, which
//   lie across the growth axis, that test depends on which side of the crown the guiding surface happens to run. The
//   closest point being on the border says the same without the axis.

#include "fusion/separate.hpp"

#include "base/option_range.hpp"
#include "rhizodont/error.hpp"

#include <utility>

namespace rhizodont {
namespace {

/// Keeps the marks of the vertices connected to `seed` through edges between marked vertices.
void keep_connected(const TriangleMesh& surface, int seed, std::vector<bool>& marked) {
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
  marked = std::move(reached);
}

}  // namespace

void require_in_range(const SeparationOptions& options) {
  require_ranges("separating crown and root", {{"epsilon", options.epsilon, OptionRange::above(0)},
                                               {"clearance", options.clearance, OptionRange::at_least(0)}});
}

std::vector<bool> separate_crown_and_root(const TriangleMesh& guiding_surface, const CrownDistances& distances,
                                          const Eigen::Vector3d& growth_axis, const SeparationOptions& options) {
  require_in_range(options);
  std::vector<bool> is_root(guiding_surface.vertices.size());
  int lowest = -1;
  double lowest_height = 0;
  for (std::size_t v = 0; v < guiding_surface.vertices.size(); ++v) {
    const double distance = distances.distance[v];
    is_root[v] = distance > options.epsilon || (distance > options.clearance && distances.closest_on_border[v]);
    if (!is_root[v]) continue;
    const double height = guiding_surface.vertices[v].dot(growth_axis);
    if (lowest >= 0 && height >= lowest_height) continue;
    lowest = static_cast<int>(v);
    lowest_height = height;
  }
  if (lowest < 0) throw NoResultError("No root was found: the predicted tooth does not reach beyond the crown.");
  keep_connected(guiding_surface, lowest, is_root);
  return is_root;
}

}  // namespace rhizodont
