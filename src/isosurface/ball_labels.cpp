// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Topology-preserving growth (simple points: Bertrand and Malandain 1994). In a tetrahedral tiling the neighbours of a
// vertex form a triangulated sphere. Changing the side of a vertex keeps the topology of the surface just if those of
// its neighbours that are inside hang together, and those outside too; then what is grown from one vertex stays a ball.
#include "isosurface/ball_labels.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <queue>

namespace rhizodont {
namespace {

constexpr std::uint32_t all_neighbours = (1U << 14) - 1;

LatticeVertex sum(const LatticeVertex& a, const LatticeVertex& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }

/// Per neighbour the others with which it shares a cell around the vertex, as bits.
std::array<std::uint32_t, 14> link_edges() {
  const auto& neighbours = lattice_neighbours();
  std::array<std::uint32_t, 14> edges{};
  for (const LatticeCell& cell : GoldbergTiling::around({0, 0, 0})) {
    std::uint32_t face = 0;
    for (const LatticeVertex& corner : GoldbergTiling::corners(cell))
      for (std::size_t n = 0; n < 14; ++n)
        if (neighbours[n] == corner) face |= 1U << n;
    for (std::size_t n = 0; n < 14; ++n)
      if (face & (1U << n)) edges[n] |= face & ~(1U << n);
  }
  return edges;
}

bool hangs_together(std::uint32_t mask, const std::array<std::uint32_t, 14>& edges) {
  if (mask == 0) return false;
  std::uint32_t reached = mask & (~mask + 1), frontier = reached;
  while (frontier != 0) {
    const auto n = static_cast<std::size_t>(std::countr_zero(frontier));
    frontier &= frontier - 1;
    const std::uint32_t next = edges[n] & mask & ~reached;
    reached |= next;
    frontier |= next;
  }
  return reached == mask;
}

std::vector<bool> simple_table() {
  const auto edges = link_edges();
  std::vector<bool> table(all_neighbours + 1);
  for (std::uint32_t mask = 0; mask <= all_neighbours; ++mask)
    table[mask] = hangs_together(mask, edges) && hangs_together(all_neighbours & ~mask, edges);
  return table;
}

/// All lattice vertices around a solid, with the field and what is inside.
class Region {
 public:
  Region(const ScalarField& field, double iso, const CutCells& cells, const GoldbergTiling& tiling, double e);

  /// Grows a ball from its deepest vertex, over vertices that `may` belong, deepest first.
  std::vector<char> grow(const std::vector<char>& may) const;
  /// Takes vertices of the ball that `may` go away, shallowest first, while it stays a ball.
  void carve(std::vector<char>& ball, const std::vector<char>& may) const;

  std::size_t size() const { return vertices.size(); }
  std::vector<LatticeVertex> vertices;
  std::vector<double> depth;   // field - iso
  std::vector<char> solid;     // inside, hollows filled and other parts left out
  std::vector<char> original;  // inside by the field

 private:
  std::uint32_t mask_of(std::size_t v, const std::vector<char>& inside) const {
    std::uint32_t mask = 0;
    for (std::size_t n = 0; n < 14; ++n) {
      const std::int32_t at = neighbours_[v][n];
      if (at >= 0 && inside[static_cast<std::size_t>(at)]) mask |= 1U << n;
    }
    return mask;
  }
  void collect(const Eigen::AlignedBox3d& box, const LatticeVertex& start, const GoldbergTiling& tiling);
  /// Vertices with the wanted entry in `side` that hang together with one of the `starts`.
  std::vector<char> reachable(std::vector<std::size_t> starts, const std::vector<char>& side, char wanted) const;

  std::vector<std::array<std::int32_t, 14>> neighbours_;  // -1 beyond the region
};

Region::Region(const ScalarField& field, double iso, const CutCells& cells, const GoldbergTiling& tiling, double e) {
  Eigen::AlignedBox3d box;
  std::vector<LatticeVertex> kept;
  for (const auto& cell : cells.cells)
    for (const std::int32_t corner : cell)
      if (cells.inside[static_cast<std::size_t>(corner)]) {
        kept.push_back(cells.vertices[static_cast<std::size_t>(corner)]);
        box.extend(tiling.position(kept.back()));
      }
  box.min().array() -= 2.0 * e;
  box.max().array() += 2.0 * e;
  collect(box, kept.front(), tiling);
  depth.resize(size());
  original.resize(size());
  tbb::parallel_for(std::size_t{0}, size(), [&](std::size_t v) {
    depth[v] = field(tiling.position(vertices[v])).value - iso;
    original[v] = depth[v] > 0.0 ? 1 : 0;
  });
  IndexMap numbers(size());
  for (std::size_t v = 0; v < size(); ++v)
    numbers.insert(GoldbergTiling::key(vertices[v]), static_cast<std::int32_t>(v));
  std::vector<std::size_t> starts, rim;
  for (const LatticeVertex& vertex : kept)
    starts.push_back(static_cast<std::size_t>(numbers.find(GoldbergTiling::key(vertex))));
  solid = reachable(starts, original, 1);
  for (std::size_t v = 0; v < size(); ++v)
    if (!solid[v] && std::ranges::count(neighbours_[v], -1) > 0) rim.push_back(v);
  const std::vector<char> open = reachable(rim, solid, 0);
  for (std::size_t v = 0; v < size(); ++v) solid[v] = open[v] ? 0 : 1;
}

void Region::collect(const Eigen::AlignedBox3d& box, const LatticeVertex& start, const GoldbergTiling& tiling) {
  IndexMap numbers;
  const auto number = [&](const LatticeVertex& vertex) {
    if (!box.contains(tiling.position(vertex))) return -1;
    const auto [index, is_new] = numbers.insert(GoldbergTiling::key(vertex), static_cast<std::int32_t>(size()));
    if (is_new) vertices.push_back(vertex);
    return index;
  };
  number(start);
  for (std::size_t v = 0; v < size(); ++v) {
    std::array<std::int32_t, 14> around{};
    for (std::size_t n = 0; n < 14; ++n) around[n] = number(sum(vertices[v], lattice_neighbours()[n]));
    neighbours_.push_back(around);
  }
}

std::vector<char> Region::reachable(std::vector<std::size_t> starts, const std::vector<char>& side, char wanted) const {
  std::vector<char> reached(size(), 0);
  for (const std::size_t v : starts) reached[v] = 1;
  while (!starts.empty()) {
    const std::size_t v = starts.back();
    starts.pop_back();
    for (const std::int32_t n : neighbours_[v]) {
      if (n < 0 || reached[static_cast<std::size_t>(n)] || side[static_cast<std::size_t>(n)] != wanted) continue;
      reached[static_cast<std::size_t>(n)] = 1;
      starts.push_back(static_cast<std::size_t>(n));
    }
  }
  return reached;
}

std::vector<char> Region::grow(const std::vector<char>& may) const {
  using Candidate = std::pair<double, std::int64_t>;  // depth, minus index: of equals the first
  std::priority_queue<Candidate> queue;
  std::size_t deepest = size();
  for (std::size_t v = 0; v < size(); ++v)
    if (may[v] && (deepest == size() || depth[v] > depth[deepest])) deepest = v;
  std::vector<char> ball(size(), 0);
  if (deepest == size()) return ball;
  const auto add = [&](std::size_t v) {
    ball[v] = 1;
    for (const std::int32_t n : neighbours_[v])
      if (n >= 0 && may[static_cast<std::size_t>(n)] && !ball[static_cast<std::size_t>(n)])
        queue.emplace(depth[static_cast<std::size_t>(n)], -n);
  };
  add(deepest);
  while (!queue.empty()) {
    const auto v = static_cast<std::size_t>(-queue.top().second);
    queue.pop();
    if (!ball[v] && is_simple(mask_of(v, ball))) add(v);
  }
  return ball;
}

void Region::carve(std::vector<char>& ball, const std::vector<char>& may) const {
  using Candidate = std::pair<double, std::int64_t>;  // minus depth, minus index
  std::priority_queue<Candidate> queue;
  for (std::size_t v = 0; v < size(); ++v)
    if (ball[v] && may[v]) queue.emplace(-depth[v], -static_cast<std::int64_t>(v));
  while (!queue.empty()) {
    const auto v = static_cast<std::size_t>(-queue.top().second);
    queue.pop();
    if (!ball[v] || !is_simple(mask_of(v, ball))) continue;
    ball[v] = 0;
    for (const std::int32_t n : neighbours_[v])
      if (n >= 0 && ball[static_cast<std::size_t>(n)] && may[static_cast<std::size_t>(n)])
        queue.emplace(-depth[static_cast<std::size_t>(n)], -n);
  }
}

}  // namespace

const std::array<LatticeVertex, 14>& lattice_neighbours() {
  static const std::array<LatticeVertex, 14> neighbours{{{1, 1, 1},
                                                         {1, 1, -1},
                                                         {1, -1, 1},
                                                         {1, -1, -1},
                                                         {-1, 1, 1},
                                                         {-1, 1, -1},
                                                         {-1, -1, 1},
                                                         {-1, -1, -1},
                                                         {2, 0, 0},
                                                         {-2, 0, 0},
                                                         {0, 2, 0},
                                                         {0, -2, 0},
                                                         {0, 0, 2},
                                                         {0, 0, -2}}};
  return neighbours;
}

bool is_simple(std::uint32_t inside_neighbours) {
  static const std::vector<bool> table = simple_table();
  return table[inside_neighbours];
}

LabelChanges changes_to_ball(const ScalarField& field, double iso, const CutCells& cells, const GoldbergTiling& tiling,
                             double e) {
  const Region region(field, iso, cells, tiling, e);
  const std::vector<char> bridges_cut = region.grow(region.solid);
  std::vector<char> tunnels_filled = region.grow(std::vector<char>(region.size(), 1));
  std::vector<char> outside(region.size());
  std::ranges::transform(region.solid, outside.begin(), [](char solid) { return static_cast<char>(1 - solid); });
  region.carve(tunnels_filled, outside);

  const auto cost = [&](const std::vector<char>& ball) {
    double total = 0.0;
    for (std::size_t v = 0; v < region.size(); ++v)
      if (ball[v] != region.solid[v]) total += std::abs(region.depth[v]);
    return total;
  };
  LabelChanges changes;
  changes.cut = cost(bridges_cut) <= cost(tunnels_filled);
  const std::vector<char>& ball = changes.cut ? bridges_cut : tunnels_filled;
  for (std::size_t v = 0; v < region.size(); ++v) {
    if (ball[v] != region.solid[v]) ++changes.count;
    if (ball[v] != region.original[v]) changes.inside.insert(GoldbergTiling::key(region.vertices[v]), ball[v]);
  }
  return changes;
}

}  // namespace rhizodont
