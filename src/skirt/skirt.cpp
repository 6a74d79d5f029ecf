// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// "Completing Dental Models While Preserving Crown Geometry and Meshing Topology", section 3.2: vertices judged to be
//   skirt are dropped before completion. Which triangles stay is decided by the caller; here only what would leave a
//   border that no root can be joined to is dropped as well.

#include "skirt/skirt.hpp"

#include "mesh/adjacency.hpp"
#include "rhizodont/error.hpp"

#include <algorithm>
#include <map>

namespace rhizodont {
namespace {

/// Keeps the component (joined over edges) with the most triangles.
void keep_largest_component(const TriangleMesh& crown, std::vector<bool>& keep) {
  const Submesh part = submesh(crown, keep);
  const ConnectedComponents components = connected_components(part.mesh);
  std::vector<int> size(static_cast<std::size_t>(components.count), 0);
  for (const int c : components.of_triangle) ++size[static_cast<std::size_t>(c)];
  const int largest = static_cast<int>(std::max_element(size.begin(), size.end()) - size.begin());
  for (std::size_t t = 0; t < part.old_triangles.size(); ++t)
    if (components.of_triangle[t] != largest) keep[static_cast<std::size_t>(part.old_triangles[t])] = false;
}

/// Drops the triangles at vertices where more than one piece of the border passes; true if there were any.
bool drop_pinches(const TriangleMesh& crown, std::vector<bool>& keep) {
  std::map<std::pair<int, int>, int> half_edges;
  for (std::size_t t = 0; t < keep.size(); ++t) {
    if (!keep[t]) continue;
    const Triangle& tri = crown.triangles[t];
    for (std::size_t i = 0; i < 3; ++i) ++half_edges[{tri[i], tri[(i + 1) % 3]}];
  }
  std::vector<int> leaving(crown.vertices.size(), 0);
  for (const auto& [h, count] : half_edges)
    if (!half_edges.contains({h.second, h.first})) leaving[static_cast<std::size_t>(h.first)] += count;
  bool any = false;
  for (std::size_t t = 0; t < keep.size(); ++t) {
    const Triangle& tri = crown.triangles[t];
    if (!keep[t] ||
        std::none_of(tri.begin(), tri.end(), [&](int v) { return leaving[static_cast<std::size_t>(v)] > 1; }))
      continue;
    keep[t] = false;
    any = true;
  }
  return any;
}

}  // namespace

KeptCrown keep_crown(const TriangleMesh& crown, const std::vector<bool>& keep, const std::string& reason) {
  std::vector<bool> mask = keep;
  do {
    if (std::none_of(mask.begin(), mask.end(), [](bool k) { return k; }))
      throw InputError("Nothing is left of the crown once its skirt and its cap are taken off.");
    keep_largest_component(crown, mask);
  } while (drop_pinches(crown, mask));

  enum class Use : std::uint8_t { none, masked, pinched, kept };
  std::vector<Use> use(crown.vertices.size(), Use::none);
  for (std::size_t t = 0; t < mask.size(); ++t)
    for (const int v : crown.triangles[t]) {
      const Use u = mask[t] ? Use::kept : (keep[t] ? Use::pinched : Use::masked);
      use[static_cast<std::size_t>(v)] = std::max(use[static_cast<std::size_t>(v)], u);
    }
  KeptCrown kept;
  for (std::size_t v = 0; v < use.size(); ++v) {
    const int id = static_cast<int>(v);
    if (use[v] == Use::none) kept.dropped.push_back({id, "unreferenced"});
    if (use[v] == Use::masked) kept.dropped.push_back({id, reason});
    if (use[v] == Use::pinched) kept.dropped.push_back({id, "pinched border"});
  }
  Submesh part = submesh(crown, mask);
  kept.mesh = std::move(part.mesh);
  kept.old_vertices = std::move(part.old_vertices);
  kept.old_triangles = std::move(part.old_triangles);
  return kept;
}

}  // namespace rhizodont
