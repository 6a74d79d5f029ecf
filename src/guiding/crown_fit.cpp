// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// "Completing Dental Models While Preserving Crown Geometry and Meshing Topology", sections 3.5 and 3.6: the guiding
//   surface must fit the crown.
// M. C. Rivara, "Algorithms for refining triangular grids suitable for adaptive and multigrid techniques", 1984.

#include "guiding/crown_fit.hpp"
#include "mesh/diagnosis.hpp"

#include "base/option_range.hpp"
#include "mesh/adjacency.hpp"
#include "mesh/at.hpp"
#include "mesh/closest_on_triangle.hpp"
#include "mesh/closest_point.hpp"
#include "mesh/geometry.hpp"
#include "mesh/self_intersection.hpp"

#include <oneapi/tbb/parallel_for.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cassert>
#include <limits>
#include <optional>
#include <tuple>
#include <vector>

namespace rhizodont {
namespace {

/// Where a vertex of the surface belongs on the crown.
class CrownPlaces {
 public:
  CrownPlaces(const PreparedCrown& crown, double reach) : crown_(crown), reach_(reach) {}

  /// The closest point of the crown if it is near and the surface runs alike there. A point of the border has to be
  /// nearer: it pulls sideways.
  std::optional<Point> place_for(const Point& p, const Eigen::Vector3d& normal, double border_reach = 0) const {
    const ClosestPoint closest = crown_.surface.closest(p);
    if (closest.distance > reach_) return std::nullopt;
    if (closest.distance > border_reach && lies_on_border(crown_, closest)) return std::nullopt;
    if (triangle_normal(crown_.mesh, at(closest.triangle)).dot(normal) < 0.3) return std::nullopt;
    return closest.point;
  }

 private:
  const PreparedCrown& crown_;
  double reach_;
};

/// A closed surface whose edges can be split.
class SplittableSurface {
 public:
  explicit SplittableSurface(TriangleMesh& mesh)
      : mesh_(mesh), neighbours_(triangle_adjacency(mesh).neighbours), touched_(mesh.triangles.size(), false) {}

  /// Splits the triangle at its longest edge, after those neighbours that have a longer one there. Returns the new
  /// vertices.
  void split(int triangle, std::vector<int>& added) {
    // Edges get longer along the chain: it ends.
    while (!touched_[at(triangle)]) {
      int t = triangle;
      for (;;) {
        const int i = longest_edge(t), other = neighbours_[at(t)][at(i)];
        if (longest_edge(other) == edge_towards(other, t, i)) {
          added.push_back(split_edge(t, i));
          break;
        }
        t = other;
      }
    }
  }
  void start_round() { touched_.assign(mesh_.triangles.size(), false); }

  double squared_distance_to(int t, const Point& p) const {
    const Triangle& c = mesh_.triangles[at(t)];
    return closest_on_triangle(p, mesh_.vertices[at(c[0])], mesh_.vertices[at(c[1])], mesh_.vertices[at(c[2])])
        .squared_distance;
  }

  double squared_longest_edge(int t) const { return squared_length(t, longest_edge(t)); }

  /// The triangle near `start` that is nearest to p, found by going downhill over the triangles around a triangle.
  int nearest_from(int start, const Point& p) const {
    int best = start;
    double least = squared_distance_to(best, p);
    for (bool better = true; better;) {
      better = false;
      for (const int t : around(best)) {
        const double d = squared_distance_to(t, p);
        if (d < least) {
          least = d;
          best = t;
          better = true;
        }
      }
    }
    return best;
  }

 private:
  double squared_length(int t, int i) const {
    const Triangle& c = mesh_.triangles[at(t)];
    return (mesh_.vertices[at(c[at(i)])] - mesh_.vertices[at(c[at((i + 1) % 3)])]).squaredNorm();
  }
  /// Equal lengths: by the vertices, so that both triangles at an edge agree.
  int longest_edge(int t) const {
    const Triangle& c = mesh_.triangles[at(t)];
    const auto rank = [&](int i) {
      const auto [low, high] = std::minmax(c[at(i)], c[at((i + 1) % 3)]);
      return std::tuple(squared_length(t, i), low, high);
    };
    int best = 0;
    for (int i = 1; i < 3; ++i)
      if (rank(i) > rank(best)) best = i;
    return best;
  }
  int edge_towards(int t, int other, int others_edge) const {
    const Triangle& o = mesh_.triangles[at(other)];
    for (int i = 0; i < 3; ++i)
      if (neighbours_[at(t)][at(i)] == other && mesh_.triangles[at(t)][at((i + 1) % 3)] == o[at(others_edge)]) return i;
    return -1;
  }
  void replace_neighbour(int t, int before, int after, int vertex) {
    for (int i = 0; i < 3; ++i)
      if (neighbours_[at(t)][at(i)] == before &&
          (mesh_.triangles[at(t)][at(i)] == vertex || mesh_.triangles[at(t)][at((i + 1) % 3)] == vertex)) {
        neighbours_[at(t)][at(i)] = after;
        return;
      }
  }

  /// Triangle t = (a, b, c) over its edge ab and the one beyond, (b, a, d), become four.
  int split_edge(int t, int i) {
    const int u = neighbours_[at(t)][at(i)], j = edge_towards(u, t, i);
    const Triangle tt = mesh_.triangles[at(t)], uu = mesh_.triangles[at(u)];
    const int a = tt[at(i)], b = tt[at((i + 1) % 3)], c = tt[at((i + 2) % 3)], d = uu[at((j + 2) % 3)];
    const int over_bc = neighbours_[at(t)][at((i + 1) % 3)], over_ca = neighbours_[at(t)][at((i + 2) % 3)];
    const int over_ad = neighbours_[at(u)][at((j + 1) % 3)], over_db = neighbours_[at(u)][at((j + 2) % 3)];
    const int m = static_cast<int>(mesh_.vertices.size());
    const int t2 = static_cast<int>(mesh_.triangles.size()), u2 = t2 + 1;
    mesh_.vertices.push_back(0.5 * (mesh_.vertices[at(a)] + mesh_.vertices[at(b)]));
    mesh_.triangles[at(t)] = {a, m, c};
    mesh_.triangles[at(u)] = {m, a, d};
    mesh_.triangles.push_back({m, b, c});
    mesh_.triangles.push_back({b, m, d});
    neighbours_[at(t)] = {u, t2, over_ca};
    neighbours_[at(u)] = {t, over_ad, u2};
    neighbours_.push_back({u2, over_bc, t});
    neighbours_.push_back({t2, u, over_db});
    replace_neighbour(over_bc, t, t2, b);
    replace_neighbour(over_db, u, u2, b);
    touched_.resize(mesh_.triangles.size(), true);
    touched_[at(t)] = touched_[at(u)] = true;
    return m;
  }

  /// All triangles that share a vertex with t, by turning around its corners: since each half-edge has one opposite,
  /// every turn comes back to t.
  std::vector<int> around(int t) const {
    std::vector<int> found;
    for (int i = 0; i < 3; ++i) {
      const int vertex = mesh_.triangles[at(t)][at(i)];
      for (int turn = neighbours_[at(t)][at(i)]; turn != t;) {
        found.push_back(turn);
        const Triangle& c = mesh_.triangles[at(turn)];
        const int k = c[0] == vertex ? 0 : c[1] == vertex ? 1 : 2;
        turn = neighbours_[at(turn)][at(k)];
      }
    }
    return found;
  }

  TriangleMesh& mesh_;
  std::vector<std::array<int, 3>> neighbours_;
  std::vector<bool> touched_;
};

/// Where each vertex is to go. Beyond the crown a vertex goes with its neighbours, ring after ring by less.
std::vector<Eigen::Vector3d> wanted_moves(const TriangleMesh& surface, const CrownPlaces& crown, int fading_rings) {
  const std::vector<Eigen::Vector3d> normals = vertex_normals(surface);
  std::vector<Eigen::Vector3d> moves(surface.vertices.size(), Eigen::Vector3d::Zero());
  std::vector<char> settled(moves.size(), 0);
  tbb::parallel_for(std::size_t{0}, moves.size(), [&](std::size_t v) {
    if (const auto place = crown.place_for(surface.vertices[v], normals[v])) {
      moves[v] = *place - surface.vertices[v];
      settled[v] = 1;
    }
  });
  for (int ring = 1; ring <= fading_rings; ++ring) {
    std::vector<Eigen::Vector3d> sum(moves.size(), Eigen::Vector3d::Zero());
    std::vector<int> count(moves.size(), 0);
    for (const Triangle& t : surface.triangles)
      for (std::size_t i = 0; i < 3; ++i) {
        const auto a = at(t[i]), b = at(t[(i + 1) % 3]);
        if (!settled[a] || settled[b]) continue;
        sum[b] += moves[a];
        ++count[b];
      }
    const double fade = static_cast<double>(fading_rings + 1 - ring) / (fading_rings + 2 - ring);
    for (std::size_t v = 0; v < moves.size(); ++v)
      if (count[v] > 0) {
        moves[v] = fade / count[v] * sum[v];
        settled[v] = 1;
      }
  }
  return moves;
}

/// Moves the vertices, those of triangles that would turn over by less.
int move_vertices(TriangleMesh& surface, std::vector<Eigen::Vector3d> moves) {
  const std::vector<Point> before = surface.vertices;
  constexpr int most_rounds = 6;
  for (int round = 0; round <= most_rounds; ++round) {
    for (std::size_t v = 0; v < moves.size(); ++v) surface.vertices[v] = before[v] + moves[v];
    bool any = false;
    std::vector<char> turned(moves.size(), 0);
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
      const Triangle& c = surface.triangles[t];
      const Eigen::Vector3d was =
          (before[at(c[1])] - before[at(c[0])]).cross(before[at(c[2])] - before[at(c[0])]).normalized();
      if (triangle_normal(surface, t).dot(was) > 0.3) continue;
      for (const int v : c) turned[at(v)] = 1;
      any = true;
    }
    if (!any) break;
    for (std::size_t v = 0; v < moves.size(); ++v)
      if (turned[v]) moves[v] *= round + 1 < most_rounds ? 0.5 : 0.0;
  }
  return static_cast<int>(std::ranges::count_if(moves, [](const Eigen::Vector3d& m) { return !m.isZero(0.0); }));
}

/// Splits triangles below or above crown vertices that are too far away, round by round.
int refine(TriangleMesh& surface, const TriangleMesh& crown, const CrownPlaces& drawn_to,
           const CrownFitOptions& options) {
  constexpr double border_reach = 0.1;  // mm
  const std::size_t first_added = surface.vertices.size();
  std::vector<int> nearest(crown.vertices.size());
  {
    const ClosestPointIndex index(surface);
    tbb::parallel_for(std::size_t{0}, nearest.size(),
                      [&](std::size_t v) { nearest[v] = index.closest(crown.vertices[v]).triangle; });
  }
  SplittableSurface splittable(surface);
  // Vertices out of reach stay so; and triangles end somewhere where they cannot come nearer.
  const double squared_tolerance = options.tolerance * options.tolerance, squared_reach = options.reach * options.reach;
  const double least_squared_edge = 36 * squared_tolerance;
  for (int round = 0; round < options.most_rounds; ++round) {
    std::vector<char> too_far(crown.vertices.size(), 0);
    tbb::parallel_for(std::size_t{0}, nearest.size(), [&](std::size_t v) {
      nearest[v] = splittable.nearest_from(nearest[v], crown.vertices[v]);
      const double squared = splittable.squared_distance_to(nearest[v], crown.vertices[v]);
      too_far[v] = squared > squared_tolerance && squared <= squared_reach &&
                   splittable.squared_longest_edge(nearest[v]) > least_squared_edge;
    });
    std::vector<int> split;
    for (std::size_t v = 0; v < nearest.size(); ++v)
      if (too_far[v]) split.push_back(nearest[v]);
    std::ranges::sort(split);
    const auto repeated = std::ranges::unique(split);
    split.erase(repeated.begin(), repeated.end());
    if (split.empty()) break;
    splittable.start_round();
    std::vector<int> added;
    for (const int t : split) splittable.split(t, added);
    const std::vector<Eigen::Vector3d> normals = vertex_normals_at(surface, added);
    std::vector<Eigen::Vector3d> moves(surface.vertices.size(), Eigen::Vector3d::Zero());
    tbb::parallel_for(std::size_t{0}, added.size(), [&](std::size_t k) {
      const auto v = at(added[k]);
      if (const auto place = drawn_to.place_for(surface.vertices[v], normals[k], border_reach))
        moves[v] = *place - surface.vertices[v];
    });
    move_vertices(surface, std::move(moves));
  }
  return static_cast<int>(surface.vertices.size() - first_added);
}

void require_in_range(const CrownFitOptions& options) {
  require_ranges("the fit to the crown", {{"tolerance", options.tolerance, OptionRange::above(0)},
                                          {"reach", options.reach, OptionRange::above(0)},
                                          {"fading_rings", options.fading_rings, OptionRange::at_least(0)},
                                          {"most_rounds", options.most_rounds, OptionRange::at_least(0)}});
}

}  // namespace

CrownFit fit_to_crown(TriangleMesh& surface, const PreparedCrown& crown, const CrownFitOptions& options) {
  assert(diagnose(surface).is_closed_manifold());
  require_in_range(options);
  const CrownPlaces drawn_to(crown, options.reach);
  const TriangleMesh before = surface;
  CrownFit fit;
  fit.moved_vertices = move_vertices(surface, wanted_moves(surface, drawn_to, options.fading_rings));
  fit.added_vertices = refine(surface, crown.mesh, drawn_to, options);
  if (!self_intersecting_triangles(surface).empty()) {
    surface = before;
    fit = {0, 0, true};
  }
  return fit;
}

}  // namespace rhizodont
