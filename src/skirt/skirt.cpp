// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// "Completing Dental Models While Preserving Crown Geometry and Meshing Topology", section 3.2: vertices judged to be
//   skirt are dropped before completion. Which triangles stay is decided by the caller; here only what would leave a
//   border that no root can be joined to is dropped as well.

#include "skirt/skirt.hpp"

#include "mesh/adjacency.hpp"
#include "rhizodont/error.hpp"

#include <algorithm>
#include <array>

namespace rhizodont {
namespace {

/// What a crown vertex is to the tooth.
enum class Use : std::uint8_t { unreferenced, masked, pinched, kept };

/// The triangles all of whose vertices are kept: a dropped triangle between kept ones would break the crown.
std::vector<bool> induced_triangles(const TriangleMesh& crown, const std::vector<Use>& use,
                                    const std::vector<bool>& never) {
  std::vector<bool> mask;
  for (const Triangle& t : crown.triangles)
    mask.push_back((never.empty() || !never[mask.size()]) && std::all_of(t.begin(), t.end(), [&](int v) {
                     return use[static_cast<std::size_t>(v)] == Use::kept;
                   }));
  return mask;
}

/// Gives up the vertices outside of the component (joined over edges) with the most triangles; true if there were any.
bool give_up_small_components(const TriangleMesh& crown, const std::vector<bool>& mask, std::vector<Use>& use) {
  const Submesh part = submesh(crown, mask);
  const ConnectedComponents components = connected_components(part.mesh);
  std::vector<int> size(static_cast<std::size_t>(components.count), 0);
  for (const int c : components.of_triangle) ++size[static_cast<std::size_t>(c)];
  const int largest = static_cast<int>(std::max_element(size.begin(), size.end()) - size.begin());
  std::vector<bool> in_largest(crown.vertices.size(), false);
  for (std::size_t t = 0; t < part.old_triangles.size(); ++t)
    if (components.of_triangle[t] == largest)
      for (const int v : crown.triangles[static_cast<std::size_t>(part.old_triangles[t])])
        in_largest[static_cast<std::size_t>(v)] = true;
  bool any = false;
  for (std::size_t v = 0; v < use.size(); ++v) {
    if (use[v] != Use::kept || in_largest[v]) continue;
    use[v] = Use::pinched;
    any = true;
  }
  return any;
}

/// Gives up the vertices that more than one piece of the border passes; true if there were any.
bool give_up_pinches(const TriangleMesh& crown, const std::vector<bool>& mask, std::vector<Use>& use) {
  const Submesh part = submesh(crown, mask);
  const EdgeTable table = edge_table(part.mesh);
  std::vector<int> leaving(crown.vertices.size(), 0);
  for (std::size_t e = 0; e < table.size(); ++e) {
    if (table.triangle_count(e) != 1) continue;
    const int from = half_edge_from(part.mesh, table.half_edges[static_cast<std::size_t>(table.first[e])]);
    ++leaving[static_cast<std::size_t>(part.old_vertices[static_cast<std::size_t>(from)])];
  }
  bool any = false;
  for (std::size_t v = 0; v < use.size(); ++v) {
    if (leaving[v] <= 1) continue;
    use[v] = Use::pinched;
    any = true;
  }
  return any;
}

}  // namespace

std::string_view reason_text(DropReason reason) {
  constexpr std::array<std::string_view, 7> texts{"unreferenced",   "cap",   "skirt", "spike", "ragged border",
                                                  "pinched border", "repair"};
  return texts[static_cast<std::size_t>(reason)];
}

KeptCrown keep_crown(const TriangleMesh& crown, const std::vector<bool>& keep, DropReason reason,
                     const std::vector<bool>& never) {
  std::vector<Use> use(crown.vertices.size(), Use::unreferenced);
  for (std::size_t t = 0; t < keep.size(); ++t)
    for (const int v : crown.triangles[t])
      use[static_cast<std::size_t>(v)] = std::max(use[static_cast<std::size_t>(v)], keep[t] ? Use::kept : Use::masked);
  std::vector<bool> mask;
  do {
    mask = induced_triangles(crown, use, never);
    if (std::none_of(mask.begin(), mask.end(), [](bool k) { return k; }))
      throw InputError("Nothing is left of the crown once its skirt and its cap are taken off.");
  } while (give_up_small_components(crown, mask, use) || give_up_pinches(crown, mask, use));

  KeptCrown kept;
  for (std::size_t v = 0; v < use.size(); ++v) {
    const int id = static_cast<int>(v);
    if (use[v] == Use::unreferenced) kept.dropped.push_back({id, DropReason::unreferenced});
    if (use[v] == Use::masked) kept.dropped.push_back({id, reason});
    if (use[v] == Use::pinched) kept.dropped.push_back({id, DropReason::pinched_border});
  }
  Submesh part = submesh(crown, mask);
  kept.mesh = std::move(part.mesh);
  kept.old_vertices = std::move(part.old_vertices);
  kept.old_triangles = std::move(part.old_triangles);
  return kept;
}

}  // namespace rhizodont
