// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Advancing front of points: R. Lohner and E. Onate, "An advancing front point generation technique", 1998; here with
// springs between the points in the place of exact apexes.

#include "fusion/root_sites.hpp"

#include "base/option_range.hpp"
#include "fusion/point_grid.hpp"
#include "mesh/at.hpp"
#include "mesh/geometry.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <queue>

namespace rhizodont {
namespace {

struct Candidate {
  double depth = 0;  // mm behind the crown's border, along the way that the front took
  int order = 0;
  SurfacePlace place;
  double size = 0;
};

struct ComesLater {
  bool operator()(const Candidate& a, const Candidate& b) const {
    return a.depth != b.depth ? a.depth > b.depth : a.order > b.order;
  }
};

class Front {
 public:
  Front(const SurfaceWalk& walk, const std::vector<bool>& is_root, const TriangleMesh& crown,
        const EdgeLengths& lengths, const RootSitesOptions& options)
      : walk_(walk),
        is_root_(is_root),
        lengths_(lengths),
        options_(options),
        grid_(bounding_box(walk.surface().vertices).merged(bounding_box(crown.vertices)), lengths.root()),
        depth_(crown.vertices.size(), 0) {
    for (const Point& p : crown.vertices) grid_.add(p);
  }

  void start_at_border(const TriangleMesh& crown, const CrownBorder& border) {
    for (const auto& [from, to] : border.half_edges) {
      const Point &a = crown.vertices[at(from)], &b = crown.vertices[at(to)];
      const int near = walk_.triangle_near(0.5 * (a + b));
      propose(b, a, near, 0, +1);
    }
    advance();
  }

  void start_where_bare() {
    const TriangleMesh& surface = walk_.surface();
    for (std::size_t v = 0; v < surface.vertices.size(); ++v) {
      if (!is_root_[v]) continue;
      const double size = lengths_.at(surface.vertices[v]);
      if (has_site_within(surface.vertices[v], 0.95 * size)) continue;
      take({0, 0, {surface.vertices[v], walk_.triangle_at(static_cast<int>(v))}, size});
      advance();
    }
  }

  std::vector<Point> sites() const {
    return {grid_.points().begin() + static_cast<std::ptrdiff_t>(grid_.points().size() - taken_), grid_.points().end()};
  }

 private:
  bool has_site_within(const Point& p, double radius) const {
    bool found = false;
    grid_.within(p, radius, [&](int) { found = true; });
    return found;
  }

  bool is_in_root(int triangle) const {
    const Triangle& t = walk_.surface().triangles[at(triangle)];
    return std::count_if(t.begin(), t.end(), [&](int v) { return is_root_[at(v)]; }) >= 2;
  }

  bool has_room(const Candidate& c) const {
    return is_in_root(c.place.triangle) && !has_site_within(c.place.point, options_.spacing * c.size);
  }

  /// Proposes the apex over p and q to the left of p -> q, seen from outside; to the right for side = -1.
  void propose(const Point& p, const Point& q, int triangle, double depth, double side) {
    const Eigen::Vector3d along = q - p;
    const Point middle = 0.5 * (p + q);
    const double size = lengths_.at(middle);
    const double height = std::sqrt(std::max(size * size - 0.25 * along.squaredNorm(), 0.25 * size * size));
    const Eigen::Vector3d left = walk_.normal(triangle).cross(along).normalized();
    Candidate c;
    c.depth = depth + height;
    c.order = order_++;
    c.place = walk_.closest(middle + side * height * left, triangle);
    c.size = lengths_.at(c.place.point);
    if (has_room(c)) queue_.push(c);
  }

  /// Shifts the candidate until it lies at the wanted distance from the sites about it.
  void settle(Candidate& c) const {
    for (int step = 0; step < options_.spring_steps; ++step) {
      Eigen::Vector3d push = Eigen::Vector3d::Zero();
      int count = 0;
      grid_.within(c.place.point, options_.spring_reach * c.size, [&](int i) {
        const Eigen::Vector3d away = c.place.point - grid_.points()[at(i)];
        const double distance = away.norm();
        if (distance > 0) push += (c.size - distance) / distance * away;
        ++count;
      });
      if (count == 0) return;
      c.place = walk_.closest(c.place.point + options_.stiffness / count * push, c.place.triangle);
    }
  }

  void take(const Candidate& c) {
    const int me = static_cast<int>(grid_.points().size());
    grid_.add(c.place.point);
    depth_.push_back(c.depth);
    ++taken_;
    std::vector<int> near;
    grid_.within(c.place.point, options_.reach * c.size, [&](int i) { near.push_back(i); });
    std::sort(near.begin(), near.end());
    for (const int i : near) {
      if (i == me) continue;
      const Point other = grid_.points()[at(i)];
      for (const double side : {1.0, -1.0})
        propose(c.place.point, other, c.place.triangle, std::min(c.depth, depth_[at(i)]), side);
    }
  }

  void advance() {
    while (!queue_.empty()) {
      Candidate c = queue_.top();
      queue_.pop();
      if (!has_room(c)) continue;
      settle(c);
      if (has_room(c)) take(c);
    }
  }

  const SurfaceWalk& walk_;
  const std::vector<bool>& is_root_;
  const EdgeLengths& lengths_;
  const RootSitesOptions& options_;
  PointGrid grid_;             // crown vertices, then sites
  std::vector<double> depth_;  // per point of the grid
  std::size_t taken_ = 0;
  int order_ = 0;
  std::priority_queue<Candidate, std::vector<Candidate>, ComesLater> queue_;
};

}  // namespace

void require_in_range(const RootSitesOptions& options) {
  require_ranges("the root's sites", {{"spacing", options.spacing, OptionRange::above(0.5).below(1)},
                                      {"reach", options.reach, OptionRange::above(1)},
                                      {"spring_reach", options.spring_reach, OptionRange::above(1)},
                                      {"stiffness", options.stiffness, OptionRange::above(0).below(2)},
                                      {"spring_steps", options.spring_steps, OptionRange::at_least(0)}});
}

std::vector<Point> root_sites(const SurfaceWalk& walk, const std::vector<bool>& is_root, const TriangleMesh& crown,
                              const CrownBorder& border, const EdgeLengths& lengths, const RootSitesOptions& options) {
  require_in_range(options);
  Front front(walk, is_root, crown, lengths, options);
  front.start_at_border(crown, border);
  front.start_where_bare();
  return front.sites();
}

}  // namespace rhizodont
