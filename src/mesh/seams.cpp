// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// G. Barequet and S. Kumar, "Repairing CAD models", IEEE Visualization 1997: borders that run along each other are
//   matched and merged ("zipped"). Here only vertices that lie opposite to each other are.

#include "mesh/seams.hpp"
#include "mesh/mesh_checks.hpp"

#include "base/option_range.hpp"
#include "mesh/adjacency.hpp"
#include "mesh/nearest_vertex.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <limits>
#include <numeric>
#include <tuple>

namespace rhizodont {
namespace {

struct Border {
  std::vector<std::array<int, 2>> edges;
  std::vector<int> vertices;  // ascending
};

Border find_border(const TriangleMesh& mesh) {
  const EdgeTable table = edge_table(mesh);
  Border border;
  for (std::size_t e = 0; e < table.size(); ++e) {
    if (table.triangle_count(e) != 1) continue;
    border.edges.push_back(table.vertices[e]);
    border.vertices.insert(border.vertices.end(), table.vertices[e].begin(), table.vertices[e].end());
  }
  std::sort(border.vertices.begin(), border.vertices.end());
  border.vertices.erase(std::unique(border.vertices.begin(), border.vertices.end()), border.vertices.end());
  return border;
}

/// Per vertex how far it may lie from one that takes its place.
std::vector<double> reaches(const TriangleMesh& mesh, const SeamOptions& options) {
  std::vector<double> shortest(mesh.vertices.size(), std::numeric_limits<double>::infinity());
  for (const Triangle& t : mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      const auto a = static_cast<std::size_t>(t[i]), b = static_cast<std::size_t>(t[(i + 1) % 3]);
      const double length = (mesh.vertices[a] - mesh.vertices[b]).norm();
      shortest[a] = std::min(shortest[a], length);
      shortest[b] = std::min(shortest[b], length);
    }
  for (double& s : shortest) s = std::min(options.most_mm, options.edge_share * s);
  return shortest;
}

/// Border vertices from low to high: each takes the place of those within reach that have none yet.
std::vector<int> gather(const TriangleMesh& mesh, const std::vector<int>& border, const SeamOptions& options) {
  std::vector<int> target(mesh.vertices.size());
  std::iota(target.begin(), target.end(), 0);
  const std::vector<double> reach = reaches(mesh, options);
  std::vector<Point> points;
  for (const int v : border) points.push_back(mesh.vertices[static_cast<std::size_t>(v)]);
  const NearestVertexIndex index(std::move(points));
  std::vector<bool> settled(mesh.vertices.size(), false);
  for (const int v : border) {
    if (settled[static_cast<std::size_t>(v)]) continue;
    settled[static_cast<std::size_t>(v)] = true;
    const double own = reach[static_cast<std::size_t>(v)];
    for (const NearVertex& near : index.within(mesh.vertices[static_cast<std::size_t>(v)], own)) {
      const auto w = static_cast<std::size_t>(border[static_cast<std::size_t>(near.index)]);
      if (settled[w] || near.squared_distance > reach[w] * reach[w]) continue;
      settled[w] = true;
      target[w] = v;
    }
  }
  return target;
}

/// Takes back what closes no seam: a vertex is merged only if one of its border edges comes to lie on another one.
void keep_what_closes(const Border& border, std::vector<int>& target) {
  using Key = std::tuple<int, int, std::size_t>;
  std::vector<Key> keys;
  for (std::size_t e = 0; e < border.edges.size(); ++e) {
    const auto [low, high] = std::minmax(target[static_cast<std::size_t>(border.edges[e][0])],
                                         target[static_cast<std::size_t>(border.edges[e][1])]);
    keys.emplace_back(low, high, e);
  }
  std::sort(keys.begin(), keys.end());
  std::vector<bool> closes(target.size(), false);
  for (std::size_t k = 1; k < keys.size(); ++k) {
    if (std::get<0>(keys[k]) != std::get<0>(keys[k - 1]) || std::get<1>(keys[k]) != std::get<1>(keys[k - 1])) continue;
    for (const std::size_t e : {std::get<2>(keys[k]), std::get<2>(keys[k - 1])})
      for (const int v : border.edges[e]) closes[static_cast<std::size_t>(v)] = true;
  }
  for (std::size_t v = 0; v < target.size(); ++v)
    if (!closes[v]) target[v] = static_cast<int>(v);
}

}  // namespace

void require_in_range(const SeamOptions& options) {
  require_ranges("a seam", {{"most_mm", options.most_mm, OptionRange::at_least(0)},
                            {"edge_share", options.edge_share, OptionRange::at_least(0).below(0.5)}});
}

Seams find_seams(const TriangleMesh& mesh, const SeamOptions& options) {
  assert(has_valid_indices(mesh) && is_finite(mesh.vertices));
  require_in_range(options);
  const Border border = find_border(mesh);
  Seams seams;
  if (border.vertices.empty()) {
    seams.target.resize(mesh.vertices.size());
    std::iota(seams.target.begin(), seams.target.end(), 0);
    return seams;
  }
  seams.target = gather(mesh, border.vertices, options);
  keep_what_closes(border, seams.target);
  for (std::size_t v = 0; v < seams.target.size(); ++v) {
    if (seams.target[v] == static_cast<int>(v)) continue;
    ++seams.merged;
    seams.largest_mm = std::max(seams.largest_mm,
                                (mesh.vertices[v] - mesh.vertices[static_cast<std::size_t>(seams.target[v])]).norm());
  }
  return seams;
}

std::string seam_width_in_words(double mm) {
  constexpr double least_said = 0.001;
  return mm < least_said ? fmt::format("less than {} mm", least_said) : fmt::format("{:.2g} mm", mm);
}

}  // namespace rhizodont
