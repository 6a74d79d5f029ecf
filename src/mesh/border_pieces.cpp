// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/border_pieces.hpp"

#include "base/disjoint_sets.hpp"
#include "mesh/adjacency.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cassert>

namespace rhizodont {

std::vector<BorderPiece> border_pieces(const TriangleMesh& mesh) {
  const EdgeTable edges = edge_table(mesh);
  DisjointSets sets(mesh.vertices.size());
  std::vector<std::pair<int, int>> half_edges;
  std::vector<bool> at_border(mesh.vertices.size(), false);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if (edges.triangle_count(e) != 1) continue;
    const int h = edges.half_edges[static_cast<std::size_t>(edges.first[e])];
    const auto [a, b] = half_edges.emplace_back(half_edge_from(mesh, h), half_edge_to(mesh, h));
    at_border[static_cast<std::size_t>(a)] = at_border[static_cast<std::size_t>(b)] = true;
    sets.join(a, b);
  }
  std::sort(half_edges.begin(), half_edges.end());
  std::vector<BorderPiece> pieces;
  std::vector<int> number(mesh.vertices.size(), -1);
  const auto piece_of = [&](int v) -> BorderPiece& {
    int& n = number[static_cast<std::size_t>(sets.find(v))];
    if (n < 0) {
      n = static_cast<int>(pieces.size());
      pieces.emplace_back();
    }
    return pieces[static_cast<std::size_t>(n)];
  };
  for (int v = 0; v < static_cast<int>(at_border.size()); ++v)
    if (at_border[static_cast<std::size_t>(v)]) piece_of(v).vertices.push_back(v);
  for (const auto& [a, b] : half_edges) {
    BorderPiece& piece = piece_of(a);
    piece.half_edges.emplace_back(a, b);
    // About a point nearby, so that places far from the origin cost no digits.
    const Point& origin = mesh.vertices[static_cast<std::size_t>(piece.vertices.front())];
    piece.area_vector += 0.5 * (mesh.vertices[static_cast<std::size_t>(a)] - origin)
                                   .cross(mesh.vertices[static_cast<std::size_t>(b)] - origin);
  }
  return pieces;
}

std::size_t base_piece(const std::vector<BorderPiece>& pieces) {
  assert(!pieces.empty());
  const auto largest = std::max_element(pieces.begin(), pieces.end(), [](const BorderPiece& x, const BorderPiece& y) {
    return x.area_vector.squaredNorm() < y.area_vector.squaredNorm();
  });
  return static_cast<std::size_t>(largest - pieces.begin());
}

}  // namespace rhizodont
