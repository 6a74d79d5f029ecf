// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// S. Katz, A. Tal, "Hierarchical mesh decomposition using fuzzy clustering and cuts", ACM Transactions on Graphics
// 22(3),
//   2003: boundaries between regions of a mesh as minimum cuts along bent edges.
#include "skirt/skirt_border.hpp"

#include "base/disjoint_sets.hpp"
#include "base/minimum_cut.hpp"
#include "base/option_range.hpp"
#include "mesh/adjacency.hpp"
#include "mesh/border_pieces.hpp"
#include "mesh/geometry.hpp"
#include "mesh/handles.hpp"
#include "rhizodont/error.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace rhizodont {
namespace {

double log_odds(double p) {
  p = std::clamp(p, 0.01, 0.99);  // no single vertex outweighs its surroundings
  return std::log(p / (1 - p));
}

/// Per vertex how sharp a crease passes through it, radians: the second of its edges by their bend inwards, since a
/// crease has two edges at a vertex and noise rarely has.
std::vector<double> creases(const TriangleMesh& mesh, const EdgeTable& table) {
  std::vector<std::array<double, 2>> sharpest(mesh.vertices.size(), {0, 0});
  for (std::size_t e = 0; e < table.size(); ++e) {
    const double inwards = -edge_bend(mesh, table, e);
    for (const int v : table.vertices[e]) {
      auto& [first, second] = sharpest[static_cast<std::size_t>(v)];
      if (inwards > first)
        second = std::exchange(first, inwards);
      else
        second = std::max(second, inwards);
    }
  }
  std::vector<double> crease;
  for (const auto& [first, second] : sharpest) crease.push_back(second);
  return crease;
}

/// What a border across each edge of the mesh costs: the length of the edge's dual, less beside a crease.
std::vector<CutEdge> cut_edges(const TriangleMesh& mesh, const SkirtBorderOptions& options) {
  const EdgeTable table = edge_table(mesh);
  const std::vector<double> crease = creases(mesh, table);
  std::vector<CutEdge> edges;
  for (std::size_t e = 0; e < table.size(); ++e) {
    const auto [a, b] = table.vertices[e];
    const double length =
        (mesh.vertices[static_cast<std::size_t>(b)] - mesh.vertices[static_cast<std::size_t>(a)]).norm();
    double area = 0;
    for (int i = table.first[e]; i < table.first[e + 1]; ++i)
      area += triangle_area(
          mesh, static_cast<std::size_t>(half_edge_triangle(table.half_edges[static_cast<std::size_t>(i)])));
    const double inwards = std::max(crease[static_cast<std::size_t>(a)], crease[static_cast<std::size_t>(b)]) /
                           (options.crease * std::numbers::pi / 180);
    const double cheap = 0.2 + 0.8 * std::exp(-inwards * inwards);
    edges.push_back({a, b, options.smoothness * cheap * (2.0 / 3) * area / std::max(length, 1e-9)});
  }
  return edges;
}

std::vector<double> vertex_areas(const TriangleMesh& mesh) {
  std::vector<double> areas(mesh.vertices.size(), 0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const int v : mesh.triangles[t]) areas[static_cast<std::size_t>(v)] += triangle_area(mesh, t) / 3;
  return areas;
}

std::vector<bool> triangles_of(const TriangleMesh& mesh, const std::vector<bool>& is_tooth) {
  std::vector<bool> keep;
  for (const Triangle& t : mesh.triangles)
    keep.push_back(std::all_of(t.begin(), t.end(), [&](int v) { return is_tooth[static_cast<std::size_t>(v)]; }));
  return keep;
}

/// Vertices joined by edges that are on one side: the number of each one's piece, and how many there are.
std::pair<std::vector<int>, int> pieces_of_vertices(const TriangleMesh& mesh, const std::vector<bool>& is_tooth) {
  DisjointSets sets(mesh.vertices.size());
  for (const Triangle& t : mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      const int a = t[i], b = t[(i + 1) % 3];
      if (is_tooth[static_cast<std::size_t>(a)] == is_tooth[static_cast<std::size_t>(b)]) sets.join(a, b);
    }
  std::vector<int> piece(mesh.vertices.size()), number(mesh.vertices.size(), -1);
  int count = 0;
  for (std::size_t v = 0; v < piece.size(); ++v) {
    int& id = number[static_cast<std::size_t>(sets.find(static_cast<int>(v)))];
    if (id < 0) id = count++;
    piece[v] = id;
  }
  return {piece, count};
}

/// One piece of tooth; skirt only where it comes from the outer border.
void remove_islands(const TriangleMesh& mesh, const std::vector<bool>& outer, const std::vector<double>& areas,
                    std::vector<bool>& is_tooth) {
  const auto [piece, count] = pieces_of_vertices(mesh, is_tooth);
  std::vector<double> area(static_cast<std::size_t>(count), 0);
  std::vector<bool> tooth(static_cast<std::size_t>(count), false), reaches(static_cast<std::size_t>(count), false);
  for (std::size_t v = 0; v < piece.size(); ++v) {
    const auto p = static_cast<std::size_t>(piece[v]);
    area[p] += areas[v];
    tooth[p] = is_tooth[v];
    if (outer[v]) reaches[p] = true;
  }
  int largest = -1;
  for (int p = 0; p < count; ++p)
    if (tooth[static_cast<std::size_t>(p)] &&
        (largest < 0 || area[static_cast<std::size_t>(p)] > area[static_cast<std::size_t>(largest)]))
      largest = p;
  for (std::size_t v = 0; v < piece.size(); ++v) {
    const auto p = static_cast<std::size_t>(piece[v]);
    is_tooth[v] = tooth[p] ? piece[v] == largest : !reaches[p];
  }
}

std::vector<bool> cut(const std::vector<float>& confidence, const std::vector<double>& areas,
                      const std::vector<CutEdge>& edges, double bias) {
  std::vector<double> cost_tooth, cost_skirt;
  for (std::size_t v = 0; v < areas.size(); ++v) {
    const double odds = log_odds(static_cast<double>(confidence[v])) - bias;
    cost_tooth.push_back(areas[v] * std::max(-odds, 0.0));
    cost_skirt.push_back(areas[v] * std::max(odds, 0.0));
  }
  std::vector<bool> is_skirt = minimum_cut(cost_skirt, cost_tooth, edges);  // the smallest skirt of equal cuts
  is_skirt.flip();
  return is_skirt;
}

void require_in_range(const SkirtBorderOptions& options) {
  require_ranges("a skirt's border", {{"threshold", options.threshold, OptionRange::above(0).below(1)},
                                      {"smoothness", options.smoothness, OptionRange::at_least(0)},
                                      {"crease", options.crease, OptionRange::above(0)},
                                      {"least_kept", options.least_kept, share_range}});
}

}  // namespace

std::vector<bool> tooth_triangles(const TriangleMesh& crown, const std::vector<float>& confidence,
                                  const SkirtBorderOptions& options) {
  require_in_range(options);
  if (confidence.size() != crown.vertices.size())
    throw UsageError("There must be one confidence for each vertex of the crown.");
  const std::vector<double> areas = vertex_areas(crown);
  const std::vector<CutEdge> edges = cut_edges(crown, options);
  std::vector<bool> outer(crown.vertices.size(), false);
  if (const std::vector<BorderPiece> border = border_pieces(crown); !border.empty())
    for (const int v : border[base_piece(border)].vertices) outer[static_cast<std::size_t>(v)] = true;
  const EdgeTable table = edge_table(crown);
  std::vector<bool> keep;
  for (double bias = log_odds(options.threshold), strictest = bias + 3; bias <= strictest; bias += 1) {
    std::vector<bool> is_tooth = cut(confidence, areas, edges, bias);
    remove_islands(crown, outer, areas, is_tooth);
    const std::vector<bool> stricter = triangles_of(crown, is_tooth);
    if (keep.empty()) keep = stricter;
    if (handle_count(crown, table, stricter) > 0) continue;
    keep = stricter;
    break;
  }
  double kept = 0, all = 0;
  for (std::size_t t = 0; t < keep.size(); ++t) {
    const double area = triangle_area(crown, t);
    all += area;
    if (keep[t]) kept += area;
  }
  if (kept < options.least_kept * all)
    throw InputError("Hardly any of the crown was recognised as tooth: if it is one, keep its skirt (--skirt keep).");
  return keep;
}

}  // namespace rhizodont
