// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// A surface leaves a tetrahedron only through faces whose corners lie on both sides, so a flood over such faces visits
// just the cells that one component cuts.
#include "isosurface/cut_cells.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "rhizodont/error.hpp"

namespace rhizodont {
namespace {

class Flood {
 public:
  Flood(const ScalarField& field, double iso, const GoldbergTiling& tiling, const IsosurfaceOptions& options,
        const IndexMap& labels)
      : field_(field), iso_(iso), tiling_(tiling), options_(options), labels_(labels) {}

  void add_seed(const Point& seed);
  CutCells result();

 private:
  struct Cell {
    LatticeCell lattice;
    std::array<std::int32_t, 4> corners;
  };

  std::int32_t vertex_index(const LatticeVertex& vertex);
  void evaluate_new_vertices();
  Cell cell_with_vertices(const LatticeCell& lattice);
  bool is_cut(const Cell& cell) const;
  std::int32_t component_near(const LatticeVertex& vertex);
  void flood(const Cell& start);
  std::optional<Point> towards_surface(const Point& p) const;

  const ScalarField& field_;
  double iso_;
  const GoldbergTiling& tiling_;
  const IsosurfaceOptions& options_;
  const IndexMap& labels_;
  IndexMap vertex_map_, cell_map_;
  std::vector<LatticeVertex> vertices_;
  std::vector<char> inside_;                // as many as have been evaluated
  std::vector<std::int32_t> component_of_;  // of vertices, -1 = none yet
  std::vector<char> searched_;              // vertices around which all cut cells are known
  std::vector<Cell> cells_;
  std::vector<std::size_t> component_begin_;  // in cells_
  std::vector<std::size_t> component_seeds_;
};

std::int32_t Flood::vertex_index(const LatticeVertex& vertex) {
  if (std::ranges::any_of(vertex, [](std::int32_t x) { return std::abs(x) >= GoldbergTiling::limit; }))
    throw NoResultError("The surface has no end: it runs out of all bounds.");
  const auto next = static_cast<std::int32_t>(vertices_.size());
  const auto [index, is_new] = vertex_map_.insert(GoldbergTiling::key(vertex), next);
  if (is_new) {
    vertices_.push_back(vertex);
    component_of_.push_back(-1);
    searched_.push_back(0);
  }
  return index;
}

void Flood::evaluate_new_vertices() {
  constexpr std::size_t grain = 128;
  const std::size_t begin = inside_.size();
  inside_.resize(vertices_.size());
  const auto evaluate = [&](std::size_t i) {
    const std::int32_t label = labels_.size() > 0 ? labels_.find(GoldbergTiling::key(vertices_[i])) : -1;
    const bool inside = label >= 0 ? label == 1 : field_(tiling_.position(vertices_[i])).value > iso_;
    inside_[i] = inside ? 1 : 0;
  };
  if (vertices_.size() - begin < grain)
    for (std::size_t i = begin; i < vertices_.size(); ++i) evaluate(i);
  else
    tbb::parallel_for(begin, vertices_.size(), evaluate);
}

Flood::Cell Flood::cell_with_vertices(const LatticeCell& lattice) {
  Cell cell{lattice, {}};
  const auto corners = GoldbergTiling::corners(lattice);
  for (std::size_t c = 0; c < 4; ++c) cell.corners[c] = vertex_index(corners[c]);
  return cell;
}

bool Flood::is_cut(const Cell& cell) const {
  int inside = 0;
  for (const std::int32_t corner : cell.corners) inside += inside_[static_cast<std::size_t>(corner)];
  return inside > 0 && inside < 4;
}

void Flood::flood(const Cell& start) {
  const auto component = static_cast<std::int32_t>(component_begin_.size());
  component_begin_.push_back(cells_.size());
  component_seeds_.push_back(0);
  cell_map_.insert(GoldbergTiling::key(start.lattice), component);
  cells_.push_back(start);
  std::size_t wave_begin = component_begin_.back();
  while (wave_begin < cells_.size()) {
    const std::size_t wave_end = cells_.size();
    for (std::size_t i = wave_begin; i < wave_end; ++i) {
      const Cell cell = cells_[i];
      for (int opposite = 0; opposite < 4; ++opposite) {
        const auto o = static_cast<std::size_t>(opposite);
        const char one = inside_[static_cast<std::size_t>(cell.corners[(o + 1) % 4])];
        const bool cut = inside_[static_cast<std::size_t>(cell.corners[(o + 2) % 4])] != one ||
                         inside_[static_cast<std::size_t>(cell.corners[(o + 3) % 4])] != one;
        if (!cut) continue;
        const LatticeCell next = GoldbergTiling::across(cell.lattice, opposite);
        if (cell_map_.insert(GoldbergTiling::key(next), component).second) cells_.push_back(cell_with_vertices(next));
      }
      for (const std::int32_t corner : cell.corners) {
        std::int32_t& of = component_of_[static_cast<std::size_t>(corner)];
        if (of < 0) of = component;
      }
    }
    if (cells_.size() > options_.max_cells)
      throw NoResultError("The surface has no end, or the edge length is far too small for it.");
    evaluate_new_vertices();
    wave_begin = wave_end;
  }
}

/// The component that cuts a cell around the vertex, found now if it is a new one; -1 if there is none.
std::int32_t Flood::component_near(const LatticeVertex& vertex) {
  const auto v = static_cast<std::size_t>(vertex_index(vertex));
  // A surface is known here. Another one that cuts cells of this very vertex matters only if all are kept.
  const bool known = component_of_[v] >= 0 && !options_.every_component;
  if (searched_[v] || known) return component_of_[v];
  searched_[v] = 1;
  const auto around = GoldbergTiling::around(vertex);
  std::array<Cell, 24> cells;
  std::ranges::transform(around, cells.begin(), [&](const LatticeCell& cell) { return cell_with_vertices(cell); });
  evaluate_new_vertices();
  for (const Cell& cell : cells)
    if (is_cut(cell) && cell_map_.find(GoldbergTiling::key(cell.lattice)) < 0) flood(cell);
  return component_of_[v];
}

/// A step along the gradient, of at most e, to where the field would reach the value if it were linear.
std::optional<Point> Flood::towards_surface(const Point& p) const {
  const FieldSample sample = field_(p);
  const double slope = sample.gradient.norm();
  if (!(slope > 0.0) || !std::isfinite(slope)) return std::nullopt;
  const double step = std::clamp((iso_ - sample.value) / slope, -options_.e, options_.e);
  return p + step / slope * sample.gradient;
}

void Flood::add_seed(const Point& seed) {
  constexpr int most_steps = 10;
  std::optional<Point> p = seed;
  for (int step = 0; step <= most_steps && p && tiling_.in_range(*p); ++step) {
    const std::int32_t component = component_near(tiling_.nearest(*p));
    if (component >= 0) {
      ++component_seeds_[static_cast<std::size_t>(component)];
      return;
    }
    p = towards_surface(*p);
  }
}

CutCells Flood::result() {
  if (component_begin_.empty())
    throw NoResultError("There is no surface near the points: the field has the same side everywhere around them.");
  const auto most = std::ranges::max_element(component_seeds_);  // the first of equals
  const auto kept = static_cast<std::size_t>(most - component_seeds_.begin());
  const bool one = !options_.every_component;
  const std::size_t begin = one ? component_begin_[kept] : 0;
  const std::size_t end = one && kept + 1 < component_begin_.size() ? component_begin_[kept + 1] : cells_.size();
  CutCells result;
  result.visited = cells_.size();
  result.other_components = component_begin_.size() - 1;
  result.cells.reserve(end - begin);
  for (std::size_t i = begin; i < end; ++i) result.cells.push_back(cells_[i].corners);
  result.inside.assign(inside_.begin(), inside_.end());
  result.vertices = std::move(vertices_);
  return result;
}

}  // namespace

CutCells find_cut_cells(const ScalarField& field, double iso, std::span<const Point> seeds,
                        const GoldbergTiling& tiling, const IsosurfaceOptions& options, const IndexMap& labels) {
  if (seeds.empty()) throw InputError("A surface can only be followed from points near it, and there are none.");
  std::vector<std::int64_t> bad;
  for (std::size_t s = 0; s < seeds.size(); ++s)
    if (!seeds[s].allFinite()) bad.push_back(static_cast<std::int64_t>(s));
  if (!bad.empty()) throw InputError("Some points have coordinates that are not numbers.", bad);
  Flood flood(field, iso, tiling, options, labels);
  for (const Point& seed : seeds) flood.add_seed(seed);
  return flood.result();
}

}  // namespace rhizodont
