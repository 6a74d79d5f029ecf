// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "arch/clearance.hpp"

#include "base/parallel_tasks.hpp"
#include "mesh/at.hpp"
#include "rhizodont/error.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

namespace rhizodont {
namespace {

/// How far apart two triangles lie at least, by the shadows that they throw along a direction of unit length.
double least_gap_along(const Eigen::Vector3d& along, const Corners& first, const Corners& second) {
  return std::min({along.dot(first[0]), along.dot(first[1]), along.dot(first[2])}) -
         std::max({along.dot(second[0]), along.dot(second[1]), along.dot(second[2])});
}

/// The smallest distance of two parts; 0 where they meet.
std::optional<Approach> distance_of_parts(const SolidSurface& first, int i, const SolidSurface& second, int j,
                                          double within) {
  std::optional<Approach> nearest;
  Eigen::Vector3d along = Eigen::Vector3d::Zero();
  const SolidSurface::Part &mine = first.part(i), &other = second.part(j);
  mine.tree.visit_nearer_pairs(other.tree, within * within, [&](int m, int n, double bound) {
    const int s = mine.triangles[at(m)], t = other.triangles[at(n)];
    const Corners mine_corners = first.corners(s), other_corners = second.corners(t);
    // Walls that face each other lie apart along much the same direction.
    if (const double gap = least_gap_along(along, mine_corners, other_corners); gap > 0 && gap * gap >= bound)
      return bound;
    const TriangleApproach found = nearest_of_triangles(mine_corners, other_corners);
    if (!(found.squared_distance < bound)) return bound;
    nearest = Approach{std::sqrt(found.squared_distance), found.on_first, found.on_second, s, t};
    along = (found.on_first - found.on_second).stableNormalized();
    return found.squared_distance;
  });
  return nearest;
}

/// A point of a solid's surface that may lie in another solid.
struct Probe {
  Point point;
  std::uint32_t parts;  // of the surface that it belongs to
  int triangle;         // that holds it
};

void add_vertices(const SolidSurface& solid, const ClosedBox& box, std::vector<Probe>& probes) {
  const TriangleMesh& mesh = solid.mesh();
  std::vector<char> done(mesh.vertices.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const int v : mesh.triangles[t]) {
      const Point& p = mesh.vertices[at(v)];
      if (std::exchange(done[at(v)], 1) || !box.meets({{p.x(), p.y(), p.z()}, {p.x(), p.y(), p.z()}})) continue;
      probes.push_back({p, solid.parts_of_vertex(at(v)), static_cast<int>(t)});
    }
}

/// Where an edge goes through another surface.
struct CutEdge {
  std::vector<double> cuts;  // parts of the way from its lower to its higher vertex
  std::uint32_t parts = 0;
  int triangle = -1;
};
using CutEdges = std::map<std::pair<int, int>, CutEdge>;

void note_cuts(const SolidSurface& solid, int triangle, const Corners& other, CutEdges& edges) {
  const Triangle& corners = solid.mesh().triangles[at(triangle)];
  for (std::size_t i = 0; i < 3; ++i) {
    const std::pair<int, int> ends = std::minmax({corners[i], corners[(i + 1) % 3]});
    const double cut =
        crossing_of_edge(solid.mesh().vertices[at(ends.first)], solid.mesh().vertices[at(ends.second)], other);
    if (cut < 0) continue;
    CutEdge& edge = edges[ends];
    edge.cuts.push_back(cut);
    edge.parts |= std::uint32_t{1} << solid.part_of(triangle);
    if (edge.triangle < 0 || triangle < edge.triangle) edge.triangle = triangle;
  }
}

void add_stretches(const SolidSurface& solid, CutEdges& edges, std::vector<Probe>& probes) {
  for (auto& [ends, edge] : edges) {
    const Point &from = solid.mesh().vertices[at(ends.first)], &to = solid.mesh().vertices[at(ends.second)];
    edge.cuts.insert(edge.cuts.end(), {0, 1});
    std::sort(edge.cuts.begin(), edge.cuts.end());
    for (std::size_t k = 1; k < edge.cuts.size(); ++k)
      if (edge.cuts[k] > edge.cuts[k - 1])
        probes.push_back({from + 0.5 * (edge.cuts[k - 1] + edge.cuts[k]) * (to - from), edge.parts, edge.triangle});
  }
}

/// Keeps the deepest of the probes of `solid` in `other`, per pair of parts. `turned`: `solid` is the second.
void note_depths(const SolidSurface& other, const std::vector<Probe>& probes, bool turned, int columns,
                 std::vector<std::optional<Approach>>& deepest) {
  std::vector<std::optional<SignedDistance>> found(probes.size());
  tbb::parallel_for(std::size_t{0}, probes.size(),
                    [&](std::size_t k) { found[k] = other.signed_distance(probes[k].point, 0); });
  for (std::size_t k = 0; k < probes.size(); ++k) {
    if (!found[k] || !(found[k]->mm < 0)) continue;
    const Probe& probe = probes[k];
    for (int p = 0; p < 32; ++p)
      for (int q = 0; q < 32; ++q) {
        if (!(probe.parts >> p & 1) || !(found[k]->parts >> q & 1)) continue;
        std::optional<Approach>& so_far = deepest[at(turned ? q * columns + p : p * columns + q)];
        if (so_far && so_far->mm <= found[k]->mm) continue;
        so_far = Approach{found[k]->mm, probe.point, found[k]->on_surface, probe.triangle, found[k]->triangle};
        if (!turned) continue;
        std::swap(so_far->on_first, so_far->on_second);
        std::swap(so_far->first_triangle, so_far->second_triangle);
      }
  }
}

/// Of solids that meet nowhere: whether the first lies in the second.
bool lies_in(const SolidSurface& first, const SolidSurface& second) {
  const Point& p = first.mesh().vertices[at(first.mesh().triangles[0][0])];
  const std::optional<SignedDistance> found = second.signed_distance(p, 0);
  return found && found->mm < 0;
}

std::optional<Approach> smaller(const std::optional<Approach>& a, const std::optional<Approach>& b) {
  if (!a || !b) return a ? a : b;
  return b->mm < a->mm ? b : a;
}

double gap(const SolidSurface& first, const SolidSurface& second) {
  return std::sqrt(first.box().squared_gap(second.box()));
}

void require_bound(double within) {
  if (!(within > 0)) throw UsageError(fmt::format("Neighbours cannot be looked for within {} mm.", within));
}

}  // namespace

std::vector<std::optional<Approach>> part_clearances(const SolidSurface& first, const SolidSurface& second,
                                                     double within) {
  const int rows = first.part_count(), columns = second.part_count();
  std::vector<std::optional<Approach>> clearances(at(rows * columns));
  CutEdges first_edges, second_edges;
  bool meet = false;
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j) {
      std::optional<Approach>& found = clearances[at(i * columns + j)];
      found = distance_of_parts(first, i, second, j, within);
      if (!found || found->mm > 0) continue;
      meet = true;
      const SolidSurface::Part &mine = first.part(i), &other = second.part(j);
      const auto pairs = mine.tree.meeting_pairs(other.tree, [&](int m, int n) {
        return triangles_meet(first.corners(mine.triangles[at(m)]), second.corners(other.triangles[at(n)]));
      });
      for (const auto& [m, n] : pairs) {
        const int s = mine.triangles[at(m)], t = other.triangles[at(n)];
        note_cuts(first, s, second.corners(t), first_edges);
        note_cuts(second, t, first.corners(s), second_edges);
      }
    }
  const bool first_in = !meet && lies_in(first, second), second_in = !meet && lies_in(second, first);
  if (!meet && !first_in && !second_in) return clearances;
  std::vector<std::optional<Approach>> deepest(clearances.size());
  std::vector<Probe> probes;
  add_vertices(first, second.box(), probes);
  add_stretches(first, first_edges, probes);
  note_depths(second, probes, false, columns, deepest);
  probes.clear();
  add_vertices(second, first.box(), probes);
  add_stretches(second, second_edges, probes);
  note_depths(first, probes, true, columns, deepest);
  for (std::size_t k = 0; k < clearances.size(); ++k)
    if (deepest[k]) clearances[k] = deepest[k];
  return clearances;
}

SolidSurface tooth_surface(TriangleMesh tooth, const std::vector<VertexSource>& source) {
  if (source.size() != tooth.vertices.size())
    throw UsageError(fmt::format("{} vertices are given with {} sources.", tooth.vertices.size(), source.size()));
  std::vector<int> parts;
  parts.reserve(tooth.triangles.size());
  for (const Triangle& t : tooth.triangles) {
    const bool crown = std::all_of(t.begin(), t.end(), [&](int v) {
      return v >= 0 && at(v) < source.size() && source[at(v)] == VertexSource::scan;
    });
    parts.push_back(crown ? crown_part : root_part);
  }
  return SolidSurface(std::move(tooth), std::move(parts), 2);
}

std::optional<Approach> Clearance::whole() const { return smaller(crown_crown, of_roots()); }
std::optional<Approach> Clearance::root_to_crown() const { return smaller(root_crown, crown_root); }
std::optional<Approach> Clearance::of_roots() const { return smaller(root_root, root_to_crown()); }

Clearance clearance_of(const SolidSurface& first, const SolidSurface& second, double within) {
  if (first.part_count() != 2 || second.part_count() != 2) throw UsageError("A tooth has two parts, crown and root.");
  const auto found = part_clearances(first, second, within);
  return {found[0], found[3], found[2], found[1]};
}

std::vector<NeighbourClearance> neighbour_clearances(const std::vector<const SolidSurface*>& teeth,
                                                     const NeighbourOptions& options) {
  require_bound(options.within);
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t i = 0; i < teeth.size(); ++i)
    for (std::size_t j = i + 1; j < teeth.size(); ++j)
      if (teeth[i] && teeth[j] && gap(*teeth[i], *teeth[j]) < options.within) pairs.emplace_back(i, j);
  std::vector<std::optional<Clearance>> found(pairs.size());
  parallel_tasks(pairs.size(), [&](std::size_t k) {
    const Clearance clearance = clearance_of(*teeth[pairs[k].first], *teeth[pairs[k].second]);
    if (const std::optional<Approach> nearest = clearance.whole(); nearest && nearest->mm < options.within)
      found[k] = clearance;
  });
  std::vector<NeighbourClearance> neighbours;
  for (std::size_t k = 0; k < pairs.size(); ++k)
    if (found[k]) neighbours.push_back({pairs[k].first, pairs[k].second, *found[k]});
  return neighbours;
}

std::vector<std::vector<double>> vertex_clearances(const std::vector<const SolidSurface*>& teeth, double within) {
  require_bound(within);
  std::vector<std::vector<double>> clearances(teeth.size());
  for (std::size_t i = 0; i < teeth.size(); ++i) {
    if (!teeth[i]) continue;
    const std::vector<Point>& vertices = teeth[i]->mesh().vertices;
    std::vector<const SolidSurface*> near;
    for (std::size_t j = 0; j < teeth.size(); ++j)
      if (j != i && teeth[j] && gap(*teeth[i], *teeth[j]) < within) near.push_back(teeth[j]);
    clearances[i].assign(vertices.size(), within);
    tbb::parallel_for(std::size_t{0}, vertices.size(), [&](std::size_t v) {
      for (const SolidSurface* other : near)
        if (const auto found = other->signed_distance(vertices[v], std::max(0.0, clearances[i][v])))
          clearances[i][v] = std::min(clearances[i][v], found->mm);
    });
  }
  return clearances;
}

}  // namespace rhizodont
