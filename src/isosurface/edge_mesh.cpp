// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// MidNormal and the removal of vertices of valence 4 (Hass and Trnkova, Approximating isosurfaces by guaranteed-quality
// triangular meshes, 2020).
#include "isosurface/edge_mesh.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <set>

#include "isosurface/incidence.hpp"
#include "isosurface/index_map.hpp"
#include "rhizodont/error.hpp"

namespace rhizodont {
namespace {

using Corner = std::size_t;  // 0..3 = A, B, C, D of a cell

class CellTriangulation {
 public:
  explicit CellTriangulation(const CutCells& cells) : cells_(cells), vertex_map_(cells.cells.size()) {}

  void add(const std::array<std::int32_t, 4>& cell) {
    std::array<Corner, 4> inside{}, outside{};
    std::size_t in = 0, out = 0;
    for (Corner c = 0; c < 4; ++c)
      (cells_.inside[static_cast<std::size_t>(cell[c])] ? inside[in++] : outside[out++]) = c;
    if (in == 1) {
      add_triangle(cell, {inside[0], inside[0], inside[0]}, {outside[0], outside[1], outside[2]});
    } else if (in == 3) {
      add_triangle(cell, {inside[0], inside[1], inside[2]}, {outside[0], outside[0], outside[0]});
    } else {
      // Around the quadrilateral: 0-0, 0-1, 1-1, 1-0 (inside-outside). Of the diagonals, the one between the long edges
      // is shorter. Where no long edge is cut, it is a square, and cut between AD and BC.
      const bool square = inside[0] + 2 == inside[1];
      const auto [p, q] = std::pair{inside[0], inside[1]};
      const auto [r, t] = std::pair{outside[0], outside[1]};
      const bool first_diagonal = square ? is_ad_or_bc(p, r) : is_long(p, r);
      if (first_diagonal) {
        add_triangle(cell, {p, p, q}, {r, t, t});
        add_triangle(cell, {p, q, q}, {r, t, r});
      } else {
        add_triangle(cell, {p, q, q}, {t, t, r});
        add_triangle(cell, {p, q, p}, {t, r, r});
      }
    }
  }

  EdgeMesh mesh;

 private:
  static bool is_long(Corner a, Corner b) { return a + 2 == b || b + 2 == a; }
  static bool is_ad_or_bc(Corner a, Corner b) { return a + b == 3; }

  /// Twice the midpoint of the edge, in lattice units.
  Eigen::Vector3i doubled_midpoint(std::int32_t a, std::int32_t b) const {
    const LatticeVertex& p = cells_.vertices[static_cast<std::size_t>(a)];
    const LatticeVertex& q = cells_.vertices[static_cast<std::size_t>(b)];
    return {p[0] + q[0], p[1] + q[1], p[2] + q[2]};
  }

  void add_triangle(const std::array<std::int32_t, 4>& cell, const std::array<Corner, 3>& inside,
                    const std::array<Corner, 3>& outside) {
    Triangle triangle{};
    std::array<Eigen::Vector3i, 3> at;
    Eigen::Vector3i outward = Eigen::Vector3i::Zero();
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t in = cell[inside[k]], out = cell[outside[k]];
      at[k] = doubled_midpoint(in, out);
      outward += doubled_midpoint(out, out) - doubled_midpoint(in, in);
      const auto key = (static_cast<std::uint64_t>(in) << 32) | static_cast<std::uint64_t>(out);
      const auto [index, is_new] = vertex_map_.insert(key, static_cast<std::int32_t>(mesh.edges.size()));
      if (is_new) mesh.edges.push_back({in, out});
      triangle[k] = index;
    }
    // In integers, hence exact.
    if ((at[1] - at[0]).cross(at[2] - at[0]).dot(outward) < 0) std::swap(triangle[1], triangle[2]);
    mesh.triangles.push_back(triangle);
  }

  const CutCells& cells_;
  IndexMap vertex_map_;
};

/// The neighbours of a vertex, counterclockwise from outside; shorter than its valence if the triangles do not form one
/// closed fan.
std::vector<std::int32_t> ring(const VertexIncidence& incidence, const std::vector<Triangle>& triangles,
                               std::int32_t vertex) {
  std::vector<std::array<std::int32_t, 2>> spans;
  for (const std::size_t t : incidence.of(vertex)) {
    const Triangle& triangle = triangles[t];
    const auto c = static_cast<std::size_t>(std::ranges::find(triangle, vertex) - triangle.begin());
    spans.push_back({triangle[(c + 1) % 3], triangle[(c + 2) % 3]});
  }
  std::vector<std::int32_t> around;
  if (spans.empty()) return around;
  std::int32_t at = spans.front()[0];
  do {
    around.push_back(at);
    const auto span = std::ranges::find(spans, at, [](const auto& s) { return s[0]; });
    if (span == spans.end()) return {};
    at = (*span)[1];
  } while (at != around.front() && around.size() < spans.size());
  if (at != around.front()) return {};
  return around;
}

class Valence4Removal {
 public:
  explicit Valence4Removal(EdgeMesh& mesh)
      : mesh_(mesh), incidence_(mesh.edges.size(), mesh.triangles), locked_(mesh.edges.size(), 0) {}

  std::size_t run() {
    std::vector<char> removed(mesh_.edges.size(), 0), dropped(mesh_.triangles.size(), 0);
    std::vector<Triangle> added;
    std::size_t count = 0;
    for (std::size_t v = 0; v < mesh_.edges.size(); ++v) {
      const auto vertex = static_cast<std::int32_t>(v);
      if (incidence_.valence(vertex) != 4 || locked_[v]) continue;
      std::vector<std::int32_t> around = ring(incidence_, mesh_.triangles, vertex);
      if (around.size() != 4 || !turn_to_diagonal(around)) continue;
      edges_added_.insert(std::minmax(around[0], around[2]));
      for (const std::int32_t n : around) locked_[static_cast<std::size_t>(n)] |= incidence_.valence(n) <= 4 ? 1 : 0;
      removed[v] = 1;
      for (const std::size_t t : incidence_.of(vertex)) dropped[t] = 1;
      added.push_back({around[0], around[1], around[2]});
      added.push_back({around[0], around[2], around[3]});
      ++count;
    }
    compact(removed, dropped, added);
    return count;
  }

 private:
  /// Turns the ring such that its first and third vertex are to be joined: those with fewer triangles, if they are not
  /// joined already. False if neither diagonal is free.
  bool turn_to_diagonal(std::vector<std::int32_t>& around) const {
    const auto sum = [&](std::size_t i) { return incidence_.valence(around[i]) + incidence_.valence(around[i + 2]); };
    if (sum(1) < sum(0)) std::ranges::rotate(around, around.begin() + 1);
    for (int attempt = 0; attempt < 2; ++attempt) {
      if (is_free(around[0], around[2])) return true;
      std::ranges::rotate(around, around.begin() + 1);
    }
    return false;
  }

  bool is_free(std::int32_t a, std::int32_t b) const {
    if (edges_added_.contains(std::minmax(a, b))) return false;
    for (const std::size_t t : incidence_.of(a))
      if (std::ranges::count(mesh_.triangles[t], b) > 0) return false;
    return true;
  }

  void compact(const std::vector<char>& removed, const std::vector<char>& dropped, const std::vector<Triangle>& added) {
    EdgeMesh result;
    std::vector<std::int32_t> renumbered(removed.size(), -1);
    for (std::size_t v = 0; v < removed.size(); ++v)
      if (!removed[v]) {
        renumbered[v] = static_cast<std::int32_t>(result.edges.size());
        result.edges.push_back(mesh_.edges[v]);
      }
    for (std::size_t t = 0; t < dropped.size(); ++t)
      if (!dropped[t]) result.triangles.push_back(mesh_.triangles[t]);
    result.triangles.insert(result.triangles.end(), added.begin(), added.end());
    for (Triangle& triangle : result.triangles)
      for (std::int32_t& v : triangle) v = renumbered[static_cast<std::size_t>(v)];
    mesh_ = std::move(result);
  }

  EdgeMesh& mesh_;
  VertexIncidence incidence_;  // of the mesh as it came: valences are those before any removal
  std::vector<char> locked_;   // next to a removed vertex: its triangles are no longer those in incidence_
  std::set<std::pair<std::int32_t, std::int32_t>> edges_added_;
};

}  // namespace

EdgeMesh triangulate_cells(const CutCells& cells) {
  CellTriangulation triangulation(cells);
  for (const auto& cell : cells.cells) triangulation.add(cell);
  return std::move(triangulation.mesh);
}

std::size_t remove_valence_4(EdgeMesh& mesh) { return Valence4Removal(mesh).run(); }

int checked_euler_number(std::size_t vertices, const std::vector<Triangle>& triangles) {
  const VertexIncidence incidence(vertices, triangles);
  std::vector<std::int64_t> bad;
  std::vector<char> reached(vertices, 0);
  std::vector<std::int32_t> stack{0};
  std::size_t corners = 0;
  for (std::size_t v = 0; v < vertices; ++v) {
    const auto vertex = static_cast<std::int32_t>(v);
    auto around = ring(incidence, triangles, vertex);
    corners += around.size();
    const bool one_fan = around.size() >= 3 && around.size() == incidence.valence(vertex);
    std::ranges::sort(around);
    if (!one_fan || std::ranges::adjacent_find(around) != around.end()) bad.push_back(vertex);
  }
  if (!bad.empty() || triangles.empty())
    throw NoResultError("The surface found is not closed or touches itself at some vertices.", bad);
  reached[0] = 1;
  std::size_t count = 0;
  while (!stack.empty()) {
    const std::int32_t v = stack.back();
    stack.pop_back();
    ++count;
    for (const std::size_t t : incidence.of(v))
      for (const std::int32_t n : triangles[t])
        if (!reached[static_cast<std::size_t>(n)]) {
          reached[static_cast<std::size_t>(n)] = 1;
          stack.push_back(n);
        }
  }
  if (count != vertices) throw NoResultError("The surface found falls into several pieces.");
  return static_cast<int>(vertices) - static_cast<int>(corners / 2) + static_cast<int>(triangles.size());
}

}  // namespace rhizodont
