// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/handles.hpp"

#include "base/disjoint_sets.hpp"

#include <array>

namespace rhizodont {
namespace {

int corner_after(int corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }

}  // namespace

int handle_count(const TriangleMesh& mesh) {
  return handle_count(mesh, edge_table(mesh), std::vector<bool>(mesh.triangles.size(), true));
}

int handle_count(const TriangleMesh& mesh, const EdgeTable& edges, const std::vector<bool>& mask) {
  const int corners = static_cast<int>(3 * mesh.triangles.size());
  // Sets of corners are the fans around vertices, sets of triangles (by their first corner) the pieces.
  DisjointSets fans(static_cast<std::size_t>(corners)), pieces(static_cast<std::size_t>(corners)),
      loops(static_cast<std::size_t>(corners));
  int edge_count = 0;
  std::vector<int> border;  // half-edges
  for (std::size_t e = 0; e < edges.size(); ++e) {
    std::array<int, 2> found{};
    std::size_t count = 0;
    for (int i = edges.first[e]; i < edges.first[e + 1]; ++i) {
      const int h = edges.half_edges[static_cast<std::size_t>(i)];
      if (mask[static_cast<std::size_t>(h / 3)] && count < 2) found[count++] = h;
    }
    if (count > 0) ++edge_count;
    if (count == 1) border.push_back(found[0]);
    if (count < 2) continue;
    fans.join(found[0], corner_after(found[1]));
    fans.join(corner_after(found[0]), found[1]);
    pieces.join(3 * (found[0] / 3), 3 * (found[1] / 3));
  }
  std::vector<bool> at_border(static_cast<std::size_t>(corners), false);
  for (const int h : border) {
    const int from = fans.find(h), to = fans.find(corner_after(h));
    at_border[static_cast<std::size_t>(from)] = at_border[static_cast<std::size_t>(to)] = true;
    loops.join(from, to);
  }
  int vertices = 0, triangles = 0, piece_count = 0, loop_count = 0;
  for (int c = 0; c < corners; ++c) {
    if (!mask[static_cast<std::size_t>(c / 3)]) continue;
    if (fans.find(c) == c) ++vertices;
    if (c % 3 == 0) ++triangles;
    if (c % 3 == 0 && pieces.find(c) == c) ++piece_count;
    if (at_border[static_cast<std::size_t>(c)] && loops.find(c) == c) ++loop_count;
  }
  return (2 * piece_count - loop_count - (vertices - edge_count + triangles)) / 2;
}

}  // namespace rhizodont
