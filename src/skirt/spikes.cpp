// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// "Completing Dental Models While Preserving Crown Geometry and Meshing Topology", section 3.2 and figure 2: spikes are
//   part of what is dropped as skirt. The sum of a vertex's corners is 2 pi less its Gauss curvature, which needs no
//   normals: those of a folded flap say nothing of the tooth, but their difference says that it is folded.
#include "skirt/spikes.hpp"

#include "base/option_range.hpp"
#include "mesh/adjacency.hpp"
#include "mesh/geometry.hpp"
#include "rhizodont/error.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace rhizodont {
namespace {

/// Vertices of the mesh that are tips.
std::vector<bool> tips(const TriangleMesh& mesh, const SpikeOptions& options) {
  std::vector<double> sum(mesh.vertices.size(), 0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto angles = triangle_angles(mesh, t);
    for (std::size_t i = 0; i < 3; ++i) sum[static_cast<std::size_t>(mesh.triangles[t][i])] += angles[i];
  }
  const EdgeTable table = edge_table(mesh);
  constexpr double degrees = 180 / std::numbers::pi;
  std::vector<bool> border(mesh.vertices.size(), false);
  for (std::size_t e = 0; e < table.size(); ++e)
    if (table.triangle_count(e) == 1)
      for (const int v : table.vertices[e]) border[static_cast<std::size_t>(v)] = true;
  std::vector<bool> tip;
  for (std::size_t v = 0; v < sum.size(); ++v)
    tip.push_back(sum[v] * degrees < (border[v] ? options.flap : options.tip));
  for (std::size_t e = 0; e < table.size(); ++e) {
    const auto [a, b] = table.vertices[e];
    if (!border[static_cast<std::size_t>(a)] && !border[static_cast<std::size_t>(b)]) continue;
    if (std::abs(edge_bend(mesh, table, e)) * degrees <= options.fin) continue;
    for (const int v : {a, b})
      if (border[static_cast<std::size_t>(v)]) tip[static_cast<std::size_t>(v)] = true;
  }
  return tip;
}

void require_in_range(const SpikeOptions& options) {
  require_ranges("a spike", {{"tip", options.tip, OptionRange::at_least(0).at_most(360)},
                             {"flap", options.flap, OptionRange::at_least(0).at_most(180)},
                             {"fin", options.fin, OptionRange::above(0).at_most(180)},
                             {"rounds", options.rounds, OptionRange::at_least(1)}});
}

}  // namespace

std::vector<bool> triangles_without_spikes(const TriangleMesh& crown, const SpikeOptions& options) {
  require_in_range(options);
  std::vector<bool> keep(crown.triangles.size(), true);
  for (int round = 0; round < options.rounds; ++round) {
    const Submesh part = submesh(crown, keep);
    const std::vector<bool> tip = tips(part.mesh, options);
    if (std::none_of(tip.begin(), tip.end(), [](bool is_tip) { return is_tip; })) break;
    for (std::size_t t = 0; t < part.mesh.triangles.size(); ++t)
      for (const int v : part.mesh.triangles[t])
        if (tip[static_cast<std::size_t>(v)]) keep[static_cast<std::size_t>(part.old_triangles[t])] = false;
  }
  return keep;
}

}  // namespace rhizodont
