// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "mesh/pieces.hpp"

#include "base/option_range.hpp"
#include "mesh/adjacency.hpp"
#include "mesh/geometry.hpp"
#include "mesh/nearest_vertex.hpp"
#include "mesh/places.hpp"
#include "mesh/seams.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <numeric>

namespace rhizodont {
namespace {

/// Per piece the vertices of its border edges, each once per edge.
std::vector<std::vector<int>> border_vertices(const TriangleMesh& mesh, const Pieces& pieces) {
  const EdgeTable table = edge_table(mesh);
  std::vector<std::vector<int>> border(pieces.kinds.size());
  for (std::size_t e = 0; e < table.size(); ++e) {
    if (table.triangle_count(e) != 1) continue;
    const int h = table.half_edges[static_cast<std::size_t>(table.first[e])];
    border[static_cast<std::size_t>(pieces.of_triangle[static_cast<std::size_t>(half_edge_triangle(h))])].push_back(
        half_edge_from(mesh, h));
  }
  return border;
}

/// Whether the pieces of like size are parts of one crown: long parts of their borders run beside each other, and they
/// open towards different sides (a half opens towards the base and towards the cut), or even nearly all of the borders
/// do. Crowns that stand in a row come near to each other beside the gum alone and open towards one side.
bool are_parts_of_one(const TriangleMesh& mesh, const Pieces& pieces) {
  constexpr double near_mm = 1, beside_mm = 2;
  constexpr double near_share = 0.5, beside_share = 0.35;  // of the border of every piece
  constexpr double same_side = 0.64;                       // cosine of 50 degrees; two halves are 90 or more apart
  const auto border = border_vertices(mesh, pieces);
  std::vector<Eigen::Vector3d> axes(border.size(), Eigen::Vector3d::Zero());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    axes[static_cast<std::size_t>(pieces.of_triangle[t])] += triangle_area_vector(mesh, t);
  bool are_near = true, are_beside = true, on_one_side = true;
  Eigen::Vector3d first_axis = Eigen::Vector3d::Zero();
  for (std::size_t p = 0; p < border.size(); ++p) {
    if (pieces.kinds[p] != PieceKind::largest && pieces.kinds[p] != PieceKind::like) continue;
    std::vector<Point> others;
    for (std::size_t q = 0; q < border.size(); ++q)
      if (q != p)
        for (const int v : border[q]) others.push_back(mesh.vertices[static_cast<std::size_t>(v)]);
    if (border[p].empty() || others.empty()) return false;
    const NearestVertexIndex index(std::move(others));
    double near = 0, beside = 0;
    for (const int v : border[p]) {
      const double squared = index.nearest(mesh.vertices[static_cast<std::size_t>(v)]).squared_distance;
      near += squared < near_mm * near_mm;
      beside += squared < beside_mm * beside_mm;
    }
    are_near = are_near && near >= near_share * static_cast<double>(border[p].size());
    are_beside = are_beside && beside >= beside_share * static_cast<double>(border[p].size());
    if (first_axis.isZero()) first_axis = axes[p].normalized();
    on_one_side = on_one_side && axes[p].normalized().dot(first_axis) > same_side;
  }
  return are_near || (are_beside && !on_one_side);
}

bool can_be_sorted(const TriangleMesh& mesh) {
  const auto count = static_cast<std::int64_t>(mesh.vertices.size());
  return std::all_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const Triangle& t) {
    return std::all_of(t.begin(), t.end(), [&](std::int32_t v) {
      return v >= 0 && v < count && mesh.vertices[static_cast<std::size_t>(v)].allFinite();
    });
  });
}

void require_in_range(const PieceOptions& options) {
  require_ranges("sorting pieces", {{"speck_area", options.speck_area, OptionRange::at_least(0).below(1)},
                                    {"speck_triangles", options.speck_triangles, OptionRange::at_least(0).below(1)},
                                    {"all_specks", options.all_specks, OptionRange::at_least(0).below(1)},
                                    {"like_share", options.like_share, OptionRange::above(0).at_most(1)}});
}

/// What lies along a seam to another piece belongs to it, however small it is.
void keep_those_at_seams(const TriangleMesh& mesh, const Pieces& pieces, std::vector<bool>& is_speck) {
  if (std::find(is_speck.begin(), is_speck.end(), true) == is_speck.end()) return;
  const Seams seams = find_seams(mesh);
  if (seams.merged == 0) return;
  std::vector<int> of_vertex(mesh.vertices.size(), -1);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const int v : mesh.triangles[t]) of_vertex[static_cast<std::size_t>(v)] = pieces.of_triangle[t];
  for (std::size_t v = 0; v < of_vertex.size(); ++v) {
    const int here = of_vertex[v], there = of_vertex[static_cast<std::size_t>(seams.target[v])];
    if (here != there) is_speck[static_cast<std::size_t>(here)] = is_speck[static_cast<std::size_t>(there)] = false;
  }
}

}  // namespace

std::size_t Pieces::count(PieceKind kind) const {
  return static_cast<std::size_t>(std::count(kinds.begin(), kinds.end(), kind));
}

Pieces sort_pieces(const TriangleMesh& mesh, const PieceOptions& options) {
  assert(can_be_sorted(mesh));
  require_in_range(options);
  const ConnectedComponents components = connected_components(mesh);
  Pieces pieces{components.of_triangle, {}};
  std::vector<double> area(static_cast<std::size_t>(components.count), 0), triangles = area;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    area[static_cast<std::size_t>(components.of_triangle[t])] += triangle_area(mesh, t);
    ++triangles[static_cast<std::size_t>(components.of_triangle[t])];
  }
  if (area.empty()) return pieces;
  const auto largest = static_cast<std::size_t>(std::max_element(area.begin(), area.end()) - area.begin());
  constexpr double many = 50;
  std::vector<bool> is_speck;
  for (std::size_t p = 0; p < area.size(); ++p) {
    const bool is_alone = triangles[p] == 1 && triangles[largest] >= many;
    const bool is_small = area[p] < options.speck_area * area[largest] &&
                          triangles[p] <= std::max(1.0, options.speck_triangles * triangles[largest]);
    is_speck.push_back(p != largest && (is_alone || is_small));
  }
  keep_those_at_seams(mesh, pieces, is_speck);
  double in_specks = 0;
  for (std::size_t p = 0; p < area.size(); ++p) {
    in_specks += is_speck[p] ? triangles[p] : 0;
    pieces.kinds.push_back(p == largest                                    ? PieceKind::largest
                           : is_speck[p]                                   ? PieceKind::speck
                           : area[p] >= options.like_share * area[largest] ? PieceKind::like
                                                                           : PieceKind::small);
  }
  if (in_specks > options.all_specks * static_cast<double>(mesh.triangles.size()))
    std::replace(pieces.kinds.begin(), pieces.kinds.end(), PieceKind::speck, PieceKind::small);
  return pieces;
}

std::string describe_pieces(const TriangleMesh& mesh, const Pieces& pieces) {
  if (pieces.kinds.size() <= 1) return {};
  const std::size_t like = 1 + pieces.count(PieceKind::like);
  if (like == 1)
    return fmt::format("Beside the crown there are {} smaller pieces that do not hang together with it.",
                       pieces.kinds.size() - 1);
  constexpr std::size_t most_teeth =
      52;  // milk teeth and all: more pieces are no crowns, and comparing them takes long
  if (like > most_teeth || are_parts_of_one(mesh, pieces))
    return like == 2 ? "The crown is in 2 halves that do not hang together: give it in one piece."
                     : fmt::format("The crown is in {} parts that do not hang together: give it in one piece.", like);
  return like == 2 ? "There are 2 crowns in the mesh: give one."
                   : fmt::format("There are {} crowns in the mesh: save each in a file of its own and give one.", like);
}

RepairedMesh drop_specks(const TriangleMesh& mesh, const PieceOptions& options) {
  require_in_range(options);
  std::vector<bool> keep(mesh.triangles.size(), true);
  RepairStep specks{RepairAction::speck_dropped, {}, {}};
  if (can_be_sorted(mesh)) {
    const Pieces pieces = sort_pieces(mesh, options);
    for (std::size_t t = 0; t < keep.size(); ++t) keep[t] = pieces.kind_of(t) != PieceKind::speck;
  }
  if (std::find(keep.begin(), keep.end(), false) == keep.end()) {
    RepairedMesh same{mesh, std::vector<int>(mesh.vertices.size()), std::vector<int>(mesh.triangles.size()), {}};
    std::iota(same.old_vertices.begin(), same.old_vertices.end(), 0);
    std::iota(same.old_triangles.begin(), same.old_triangles.end(), 0);
    return same;
  }
  Submesh rest = submesh(mesh, keep);
  const std::vector<int> place = first_at_place(mesh.vertices);
  std::vector<bool> place_left(mesh.vertices.size(), false), is_settled(mesh.vertices.size(), false);
  for (const int v : rest.old_vertices) {
    place_left[static_cast<std::size_t>(place[static_cast<std::size_t>(v)])] = true;
    is_settled[static_cast<std::size_t>(v)] = true;
  }
  for (std::size_t t = 0; t < keep.size(); ++t) {
    if (keep[t]) continue;
    bool all_left = true;
    for (const int v : mesh.triangles[t]) {
      all_left = all_left && place_left[static_cast<std::size_t>(place[static_cast<std::size_t>(v)])];
      if (is_settled[static_cast<std::size_t>(v)]) continue;
      is_settled[static_cast<std::size_t>(v)] = true;
      specks.vertices.push_back(v);
    }
    if (all_left) specks.triangles.push_back(static_cast<int>(t));
  }
  std::sort(specks.vertices.begin(), specks.vertices.end());
  return {std::move(rest.mesh), std::move(rest.old_vertices), std::move(rest.old_triangles), {std::move(specks)}};
}

}  // namespace rhizodont
