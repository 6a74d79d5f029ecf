// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// What hole fillers leave: G. H. Meisters, "Polygons have ears", American Mathematical Monthly 82(6), 1975 (a polygon
// cut
//   into triangles between its own corners has no inner vertex, and its triangles hang together as a tree); fans about
//   a centre; and extrusions, whose walls are rows of as many quads as the border has edges.

#include "skirt/made_cap.hpp"
#include "mesh/diagnosis.hpp"

#include "base/option_range.hpp"
#include "mesh/adjacency.hpp"
#include "mesh/geometry.hpp"
#include "skirt/cap.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>
#include <queue>
#include <set>

namespace rhizodont {
namespace {

using Mask = std::vector<bool>;

/// The closed crown with what is asked of it again and again.
struct Closed {
  const TriangleMesh& mesh;
  TriangleAdjacency adjacency;
  VertexTriangles around;
  std::vector<Eigen::Vector3d> normals;
  double median_edge = 0;

  explicit Closed(const TriangleMesh& closed)
      : mesh(closed), adjacency(triangle_adjacency(closed)), around(vertex_triangles(closed)) {
    std::vector<double> lengths;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      normals.push_back(triangle_normal(mesh, t));
      for (std::size_t e = 0; e < 3; ++e) lengths.push_back(edge_length(t, e));
    }
    const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
    std::nth_element(lengths.begin(), middle, lengths.end());
    median_edge = *middle;
  }

  std::size_t size() const { return mesh.triangles.size(); }
  int corner(std::size_t t, std::size_t i) const { return mesh.triangles[t][i % 3]; }
  const Point& at(std::size_t t, std::size_t i) const { return mesh.vertices[static_cast<std::size_t>(corner(t, i))]; }
  double edge_length(std::size_t t, std::size_t e) const { return (at(t, e) - at(t, e + 1)).norm(); }
  std::size_t beyond(std::size_t t, std::size_t e) const {
    return static_cast<std::size_t>(adjacency.neighbours[t][e % 3]);
  }
  /// Angle between the triangles on both sides of an edge, degrees.
  double bend(std::size_t t, std::size_t e) const {
    const Eigen::Vector3d& here = normals[t];
    const Eigen::Vector3d& there = normals[beyond(t, e)];
    return std::atan2(here.cross(there).norm(), here.dot(there)) * 180 / M_PI;
  }
};

/// The star of the vertex with the widest fan. A vertex of the border that a base is fanned out from has short edges of
/// the crown as well, a centre has not.
Mask widest_fan(const Closed& crown, const MadeCapOptions& options) {
  constexpr double least_spoke = 0.25;  // of the mean one
  Mask best(crown.size(), false);
  double widest = 0;
  std::size_t centre = crown.mesh.vertices.size();
  for (std::size_t v = 0; v < crown.mesh.vertices.size(); ++v) {
    const int count = crown.around.first[v + 1] - crown.around.first[v];
    if (count < options.least_fan) continue;
    double shortest = std::numeric_limits<double>::infinity(), sum = 0;
    Eigen::Vector3d area = Eigen::Vector3d::Zero();
    for (int k = crown.around.first[v]; k < crown.around.first[v + 1]; ++k) {
      const auto t = static_cast<std::size_t>(crown.around.triangles[static_cast<std::size_t>(k)]);
      area += triangle_area_vector(crown.mesh, t);
      for (std::size_t e = 0; e < 3; ++e) {
        if (crown.corner(t, e) != static_cast<int>(v)) continue;
        shortest = std::min(shortest, crown.edge_length(t, e));
        sum += crown.edge_length(t, e);
      }
    }
    if (shortest < least_spoke * sum / count || area.norm() <= widest) continue;
    widest = area.norm();
    centre = v;
  }
  if (centre == crown.mesh.vertices.size()) return best;
  for (int k = crown.around.first[centre]; k < crown.around.first[centre + 1]; ++k)
    best[static_cast<std::size_t>(crown.around.triangles[static_cast<std::size_t>(k)])] = true;
  return best;
}

/// The largest region in one plane.
Mask largest_flat_region(const Closed& crown, const MadeCapOptions& options) {
  std::vector<std::size_t> order(crown.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::vector<double> area;
  for (const std::size_t t : order) area.push_back(triangle_area(crown.mesh, t));
  std::stable_sort(order.begin(), order.end(), [&](std::size_t x, std::size_t y) { return area[x] > area[y]; });
  Mask seen(crown.size(), false), best(crown.size(), false);
  double largest = 0;
  for (const std::size_t seed : order) {
    if (seen[seed]) continue;
    const Eigen::Vector3d& normal = crown.normals[seed];
    const auto is_flat = [&](std::size_t t) {
      if (crown.normals[t].dot(normal) < 0.9) return false;
      for (std::size_t i = 0; i < 3; ++i)
        if (std::abs(normal.dot(crown.at(t, i) - crown.at(seed, 0))) > options.flat_mm) return false;
      return true;
    };
    std::vector<std::size_t> region{seed};
    seen[seed] = true;
    double sum = 0;
    for (std::size_t k = 0; k < region.size(); ++k) {
      sum += area[region[k]];
      for (std::size_t e = 0; e < 3; ++e) {
        const std::size_t n = crown.beyond(region[k], e);
        if (seen[n] || !is_flat(n)) continue;
        seen[n] = true;
        region.push_back(n);
      }
    }
    if (sum <= largest) continue;
    largest = sum;
    best.assign(crown.size(), false);
    for (const std::size_t t : region) best[t] = true;
  }
  return best;
}

/// A polygon cut into triangles between its own corners, as far as it is known: each triangle that joins it brings a
/// new corner.
class BasePolygon {
 public:
  BasePolygon(const Closed& crown, const MadeCapOptions& options)
      : crown_(crown), options_(options), in_(crown.size(), false), corners_(crown.mesh.vertices.size(), false) {
    grow_over_long_edges();
    if (count_ == 0) return;
    follow_file_order();
    take_ears();
  }

  const Mask& triangles() const { return in_; }

 private:
  void add(std::size_t t) {
    in_[t] = true;
    ++count_;
    for (std::size_t e = 0; e < 3; ++e) note_rim(t, e, in_[crown_.beyond(t, e)] ? -1 : 1);
    for (std::size_t i = 0; i < 3; ++i) corners_[static_cast<std::size_t>(crown_.corner(t, i))] = true;
  }
  void remove_last(std::size_t t) {
    const std::size_t e = joining_edge(t);
    in_[t] = false;
    --count_;
    for (std::size_t k = 0; k < 3; ++k) note_rim(t, k, in_[crown_.beyond(t, k)] ? 1 : -1);
    corners_[static_cast<std::size_t>(crown_.corner(t, e + 2))] = false;
  }

  /// The edge over which t hangs on the polygon; 3 where it does not, or not by one edge with a corner of its own.
  std::size_t joining_edge(std::size_t t) const {
    for (std::size_t e = 0; e < 3; ++e)
      if (in_[crown_.beyond(t, e)])
        return corners_[static_cast<std::size_t>(crown_.corner(t, e + 2))] && !in_[t] ? 3 : e;
    return 3;
  }
  bool can_join(std::size_t t) const { return !in_[t] && joining_edge(t) < 3; }

  void grow_over_long_edges() {
    using Step = std::pair<double, std::size_t>;  // edge's length, 3 t + e of the half-edge on the side that is in
    double longest = 0;
    std::size_t seed = 0;
    for (std::size_t t = 0; t < crown_.size(); ++t)
      for (std::size_t e = 0; e < 3; ++e)
        if (crown_.edge_length(t, e) > longest) longest = crown_.edge_length(t, e), seed = t;
    if (longest < options_.long_edge * crown_.median_edge) return;
    std::priority_queue<Step> steps;
    const auto take = [&](std::size_t t) {
      add(t);
      for (std::size_t e = 0; e < 3; ++e) steps.emplace(crown_.edge_length(t, e), 3 * t + e);
    };
    take(seed);
    while (!steps.empty() && steps.top().first > options_.long_edge * crown_.median_edge) {
      const std::size_t n = crown_.beyond(steps.top().second / 3, steps.top().second % 3);
      steps.pop();
      if (can_join(n)) take(n);
    }
  }

  /// An edge comes to the rim or goes from it.
  void note_rim(std::size_t t, std::size_t e, int sign) {
    const double length = crown_.edge_length(t, e);
    rim_length_ += sign * length;
    rim_bend_sum_ += sign * length * crown_.bend(t, e);
  }

  /// Mean bend at the polygon's rim, degrees.
  double rim_bend() const { return rim_length_ > 0 ? rim_bend_sum_ / rim_length_ : 0; }

  /// Takes triangles beside the polygon that can join and that `accept` takes, by ascending numbers and again while
  /// there are some. One that was not taken is looked at again once another one beside it was.
  template <class Accept>
  void spread(const Accept& accept) {
    std::set<std::size_t> beside;
    const auto note_beside = [&](std::size_t t) {
      for (std::size_t e = 0; e < 3; ++e)
        if (const std::size_t n = crown_.beyond(t, e); !in_[n]) beside.insert(n);
    };
    for (std::size_t t = 0; t < crown_.size(); ++t)
      if (in_[t]) note_beside(t);
    while (!beside.empty())
      for (auto place = beside.begin(); place != beside.end();) {
        const std::size_t t = *place;
        beside.erase(place);
        if (can_join(t) && accept(t)) {
          add(t);
          note_beside(t);
        }
        place = beside.upper_bound(t);
      }
  }

  /// Programs write the triangles that they add one after the other. Where the polygon's lie so, all between them are
  /// taken, and of those before and after as many as leave it with the sharpest rim.
  void follow_file_order() {
    std::size_t low = crown_.size(), high = 0;
    for (std::size_t t = 0; t < crown_.size(); ++t)
      if (in_[t]) low = std::min(low, t), high = t;
    if (static_cast<double>(high - low + 1) > 3.0 * static_cast<double>(count_) + 8) return;
    std::vector<std::size_t> added;
    spread([&](std::size_t t) {
      if (t < low || t > high) return false;
      added.push_back(t);
      return true;
    });
    if (count_ != high - low + 1) {
      for (auto t = added.rbegin(); t != added.rend(); ++t) remove_last(*t);
      return;
    }
    lengthen([&](std::size_t k) { return low > k ? low - 1 - k : crown_.size(); });
    lengthen([&](std::size_t k) { return std::min(high + 1 + k, crown_.size()); });
  }

  /// Takes triangles in the given order while they can join, then gives back the last ones down to the sharpest rim.
  template <class Order>
  void lengthen(const Order& triangle_at) {
    std::vector<std::size_t> run;
    double sharpest = rim_bend();
    std::size_t best = 0;
    for (std::size_t t = triangle_at(0); t < crown_.size() && can_join(t); t = triangle_at(run.size())) {
      add(t);
      run.push_back(t);
      if (const double bend = rim_bend(); bend >= sharpest) sharpest = bend, best = run.size();
    }
    while (run.size() > best) {
      remove_last(run.back());
      run.pop_back();
    }
  }

  /// Longer than all but a few of the edges away from the polygon, mm.
  double too_long_for_crown() const {
    constexpr double few = 0.001;
    constexpr double clearly = 1.05;
    std::vector<double> lengths;
    for (std::size_t t = 0; t < crown_.size(); ++t) {
      const Triangle& c = crown_.mesh.triangles[t];
      if (std::any_of(c.begin(), c.end(), [&](int v) { return corners_[static_cast<std::size_t>(v)]; })) continue;
      for (std::size_t e = 0; e < 3; ++e) lengths.push_back(crown_.edge_length(t, e));
    }
    if (lengths.empty()) return std::numeric_limits<double>::infinity();
    const auto place =
        lengths.begin() + static_cast<std::ptrdiff_t>((1 - few) * static_cast<double>(lengths.size() - 1));
    std::nth_element(lengths.begin(), place, lengths.end());
    return clearly * *place;
  }

  /// Triangles beyond an edge that is too long for a crown's border, and those that continue the polygon more smoothly
  /// than the crown.
  void take_ears() {
    constexpr double clearly = 10;  // degrees
    const double too_long = too_long_for_crown();
    spread([&](std::size_t t) {
      const std::size_t e = joining_edge(t);
      const double inward = crown_.bend(t, e);
      const double outward = 0.5 * (crown_.bend(t, e + 1) + crown_.bend(t, e + 2));
      return crown_.edge_length(t, e) >= too_long || inward + clearly <= outward;
    });
  }

  const Closed& crown_;
  const MadeCapOptions& options_;
  Mask in_;
  Mask corners_;  // per vertex
  std::size_t count_ = 0;
  double rim_length_ = 0;    // mm
  double rim_bend_sum_ = 0;  // of its edges, bend times length
};

/// Vertices on the rim of a region, if it is one simple loop; else none.
std::vector<int> simple_rim(const Closed& crown, const Mask& region) {
  std::vector<int> next(crown.mesh.vertices.size(), -1);
  std::size_t edges = 0;
  int start = -1;
  for (std::size_t t = 0; t < crown.size(); ++t)
    for (std::size_t e = 0; region[t] && e < 3; ++e) {
      if (region[crown.beyond(t, e)]) continue;
      start = crown.corner(t, e);
      if (next[static_cast<std::size_t>(start)] >= 0) return {};
      next[static_cast<std::size_t>(start)] = crown.corner(t, e + 1);
      ++edges;
    }
  std::vector<int> rim;
  for (int v = start; v >= 0 && rim.size() <= edges; v = next[static_cast<std::size_t>(v)]) {
    rim.push_back(v);
    if (next[static_cast<std::size_t>(v)] == start) break;
  }
  return rim.size() == edges ? rim : std::vector<int>{};
}

/// Adds the next row of a wall: as many quads as the rim has edges, on as many new vertices. False where there is none.
bool add_row(const Closed& crown, Mask& region) {
  const std::vector<int> rim = simple_rim(crown, region);
  std::vector<int> uses(crown.mesh.vertices.size(), 0);
  std::vector<bool> on_rim(crown.mesh.vertices.size(), false);
  for (const int v : rim) on_rim[static_cast<std::size_t>(v)] = true;
  std::vector<std::size_t> row;
  for (std::size_t t = 0; t < crown.size(); ++t) {
    const Triangle& c = crown.mesh.triangles[t];
    if (region[t] || std::none_of(c.begin(), c.end(), [&](int v) { return on_rim[static_cast<std::size_t>(v)]; }))
      continue;
    row.push_back(t);
    for (const int v : c) ++uses[static_cast<std::size_t>(v)];
  }
  if (rim.empty() || row.size() != 2 * rim.size()) return false;
  std::size_t fresh = 0;
  for (std::size_t v = 0; v < uses.size(); ++v) {
    if (uses[v] == 0) continue;
    if (uses[v] != 3) return false;  // all quads are cut along the same diagonal; no row of a scan is so regular
    fresh += !on_rim[v];
  }
  if (fresh != rim.size()) return false;
  for (const std::size_t t : row) region[t] = true;
  return simple_rim(crown, region).size() == rim.size();
}

/// How far the corners of a flat region lie from its plane, mm: as little as the file's digits allow.
double roughness(const Closed& crown, const Mask& region, const Eigen::Vector3d& direction) {
  double low = std::numeric_limits<double>::infinity(), high = -low, farthest = 0;
  for (std::size_t t = 0; t < crown.size(); ++t)
    for (std::size_t i = 0; region[t] && i < 3; ++i) {
      const Point& p = crown.at(t, i);
      low = std::min(low, p.dot(direction));
      high = std::max(high, p.dot(direction));
      farthest = std::max(farthest, p.cwiseAbs().maxCoeff());
    }
  return std::max(high - low, farthest * std::numeric_limits<float>::epsilon());
}

/// Walls of a flat base that stand upright on it, as exactly as the base is flat, however they are triangulated.
void add_upright_walls(const Closed& crown, Mask& region, const Eigen::Vector3d& direction) {
  constexpr double upright = 1e-5;       // cosine: what of the crown happens to stand so is very little
  constexpr double most_upright = 2e-3;  // cosine, also of needles, whose direction the digits leave open
  constexpr double least_height = 1;     // mm: lower ones are crown that happens to be upright
  const double rough = roughness(crown, region, direction);
  const auto is_upright = [&](std::size_t t) {
    double longest = 0;
    for (std::size_t e = 0; e < 3; ++e) longest = std::max(longest, crown.edge_length(t, e));
    const double height = 2 * triangle_area(crown.mesh, t) / longest;
    return std::abs(crown.normals[t].dot(direction)) <= std::min(most_upright, upright + 2 * rough / height);
  };
  Mask with_walls = region;
  std::vector<std::size_t> open;
  double rim = 0, walls = 0;
  for (std::size_t t = 0; t < crown.size(); ++t)
    for (std::size_t e = 0; region[t] && e < 3; ++e)
      if (!region[crown.beyond(t, e)]) open.push_back(t), rim += crown.edge_length(t, e);
  for (std::size_t k = 0; k < open.size(); ++k)
    for (std::size_t e = 0; e < 3; ++e) {
      const std::size_t n = crown.beyond(open[k], e);
      if (with_walls[n] || !is_upright(n)) continue;
      with_walls[n] = true;
      walls += triangle_area(crown.mesh, n);
      open.push_back(n);
    }
  if (walls > least_height * rim) region = with_walls;
}

Eigen::Vector3d area_vector_of(const Closed& crown, const Mask& region) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t t = 0; t < crown.size(); ++t)
    if (region[t]) sum += triangle_area_vector(crown.mesh, t);
  return sum;
}

double area_of(const Closed& crown, const Mask& region) {
  double sum = 0;
  for (std::size_t t = 0; t < crown.size(); ++t)
    if (region[t]) sum += triangle_area(crown.mesh, t);
  return sum;
}

/// Area over that of a circle with the same rim.
double roundness(const Closed& crown, const Mask& region) {
  double rim = 0;
  for (std::size_t t = 0; t < crown.size(); ++t)
    for (std::size_t e = 0; region[t] && e < 3; ++e)
      if (!region[crown.beyond(t, e)]) rim += crown.edge_length(t, e);
  return rim > 0 ? 4 * M_PI * area_of(crown, region) / (rim * rim) : 0;
}

/// Area of a region that may be a cap; 0 where it cannot be one.
double area_of_cap(const Closed& crown, const Mask& region, const MadeCapOptions& options) {
  const Eigen::Vector3d vector = area_vector_of(crown, region);
  double area = 0, left = 0;
  std::size_t rim = 0;
  for (std::size_t t = 0; t < crown.size(); ++t) {
    (region[t] ? area : left) += triangle_area(crown.mesh, t);
    for (std::size_t e = 0; region[t] && e < 3; ++e) rim += !region[crown.beyond(t, e)];
  }
  if (!(vector.norm() > 0) || static_cast<int>(rim) < options.least_rim || left < options.least_crown * (area + left))
    return 0;
  const double share = vector.norm() / outline_area(crown.mesh, vector.normalized());
  return share >= options.least_share ? area : 0;
}

void require_in_range(const MadeCapOptions& options) {
  require_ranges("a made cap", {{"least_fan", options.least_fan, OptionRange::above(8)},
                                {"long_edge", options.long_edge, OptionRange::above(1)},
                                {"flat_mm", options.flat_mm, OptionRange::above(0)},
                                {"least_rim", options.least_rim, OptionRange::at_least(3)},
                                {"least_share", options.least_share, OptionRange::above(0).at_most(1)},
                                {"least_flatness", options.least_flatness, share_range},
                                {"least_roundness", options.least_roundness, OptionRange::at_least(0).below(1)},
                                {"least_crown", options.least_crown, OptionRange::at_least(0).below(1)}});
}

}  // namespace

std::optional<std::vector<bool>> find_made_cap(const TriangleMesh& closed_crown, const MadeCapOptions& options) {
  assert(diagnose(closed_crown).is_closed_manifold());
  require_in_range(options);
  const Closed crown(closed_crown);
  Mask best;
  double largest = 0;
  const auto consider = [&](const Mask& region) {
    const double area = area_of_cap(crown, region, options);
    if (area > largest) largest = area, best = region;
    return area > 0;
  };
  const auto consider_with_rows = [&](const Mask& core, bool is_flat) {
    if (area_vector_of(crown, core).norm() < options.least_flatness * area_of(crown, core)) return;
    if (roundness(crown, core) < options.least_roundness) return;
    Mask region = core;
    while (add_row(crown, region)) {
    }
    if (is_flat) add_upright_walls(crown, region, area_vector_of(crown, core).normalized());
    if (!consider(region)) consider(core);
  };
  consider_with_rows(widest_fan(crown, options), false);
  consider_with_rows(largest_flat_region(crown, options), true);
  consider_with_rows(BasePolygon(crown, options).triangles(), false);
  if (largest == 0) return std::nullopt;
  return best;
}

}  // namespace rhizodont
