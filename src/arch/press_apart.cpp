// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// M. Botsch and L. Kobbelt, "An intuitive framework for real-time freeform modeling", 2004: a surface that follows
// what is pulled at it.

#include "arch/press_apart.hpp"

#include "arch/clearance.hpp"
#include "arch/solid_surface.hpp"
#include "base/option_range.hpp"
#include "base/parallel_tasks.hpp"
#include "fusion/biharmonic.hpp"
#include "fusion/safe_moves.hpp"
#include "mesh/at.hpp"
#include "mesh/edge_distance.hpp"
#include "mesh/geometry.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <utility>

namespace rhizodont {
namespace {

using Wishes = std::vector<std::optional<Eigen::Vector3d>>;  // per vertex, mm

/// Two teeth, and where they lie deepest in each other.
struct PressedPair {
  ToothPair teeth;
  Approach deepest;
};

class Pressing {
 public:
  Pressing(const std::vector<JoinedTooth>& teeth, const PressOptions& options)
      : teeth_(teeth), options_(options), surfaces_(teeth.size()), wishes_(teeth.size()), missing_(teeth.size()) {
    for (const JoinedTooth& tooth : teeth) pressed_.meshes.push_back(tooth.mesh);
    pressed_.largest_mm.assign(teeth.size(), 0);
    for (std::size_t i = 0; i < teeth.size(); ++i) wishes_[i].resize(teeth[i].mesh.vertices.size());
    std::vector<char> all(teeth.size(), 1);
    measure(all);
  }

  PressedTeeth run() {
    for (int round = 0; round < options_.rounds; ++round) {
      std::vector<char> moved(teeth_.size(), 0);
      for (Wishes& missing : missing_) missing.assign(missing.size(), std::nullopt);
      for (const PressedPair& pair : to_press()) {
        ask_at_deepest(pair);
        ask_at_vertices(pair.teeth.first, pair.teeth.second);
        ask_at_vertices(pair.teeth.second, pair.teeth.first);
      }
      parallel_tasks(teeth_.size(), [&](std::size_t i) { moved[i] = give_way(i) ? 1 : 0; });
      if (std::none_of(moved.begin(), moved.end(), [](char m) { return m != 0; })) break;
      measure(moved);
    }
    return std::move(pressed_);
  }

 private:
  /// Surfaces of those marked.
  void measure(const std::vector<char>& marked) {
    parallel_tasks(teeth_.size(), [&](std::size_t i) {
      if (!marked[i] || teeth_[i].crown_vertices == 0) return;
      const TriangleMesh& mesh = pressed_.meshes[i];
      surfaces_[i] = std::make_unique<SolidSurface>(mesh, std::vector<int>(mesh.triangles.size(), 0), 1);
      missing_[i].resize(mesh.vertices.size());
    });
  }

  /// Pairs that lie in each other and that the last round has helped. What is left of others is scan in scan, or deeper
  /// than surfaces may move.
  std::vector<PressedPair> to_press() {
    constexpr double helped = 0.9;
    std::vector<ToothPair> pairs;
    for (std::size_t i = 0; i < teeth_.size(); ++i)
      for (std::size_t j = i + 1; j < teeth_.size(); ++j) pairs.emplace_back(i, j);
    std::vector<std::optional<Approach>> deepest(pairs.size());
    parallel_tasks(pairs.size(), [&](std::size_t k) { deepest[k] = deepest_of(pairs[k].first, pairs[k].second); });
    std::vector<PressedPair> found;
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      const double depth = deepest[k] ? -deepest[k]->mm : std::numeric_limits<double>::infinity();
      const auto before = depth_.find(pairs[k]);
      if (deepest[k] && (before == depth_.end() || depth < helped * before->second))
        found.push_back({pairs[k], *deepest[k]});
      depth_[pairs[k]] = depth;
    }
    return found;
  }

  /// Nothing where the two do not lie in each other.
  std::optional<Approach> deepest_of(std::size_t i, std::size_t j) const {
    if (!surfaces_[i] || !surfaces_[j] || surfaces_[i]->box().squared_gap(surfaces_[j]->box()) > 0) return {};
    const auto approach = part_clearances(*surfaces_[i], *surfaces_[j], options_.gap)[0];
    return approach && approach->mm < 0 ? approach : std::nullopt;
  }

  bool may_move(std::size_t tooth, int vertex) const { return vertex >= teeth_[tooth].crown_vertices; }

  /// The corners of a triangle that hold a point of it: of one on an edge its two ends, whichever triangle beside that
  /// edge is asked.
  std::vector<int> holders(std::size_t tooth, int triangle, const Point& p) const {
    constexpr double hardly = 1e-6;
    const std::array<double, 3> shares = surfaces_[tooth]->barycentric(triangle, p);
    const Triangle& corners = pressed_.meshes[tooth].triangles[at(triangle)];
    std::vector<int> holding;
    for (std::size_t k = 0; k < 3; ++k)
      if (shares[k] > hardly) holding.push_back(corners[k]);
    return holding;
  }

  /// Edges may be thrust through each other with all vertices outside.
  void ask_at_deepest(const PressedPair& pair) {
    const auto [i, j] = pair.teeth;
    const Approach& deepest = pair.deepest;
    Eigen::Vector3d out = deepest.on_second - deepest.on_first;
    if (out.norm() < 1e-9) out = triangle_normal(pressed_.meshes[j], at(deepest.second_triangle));
    out *= (options_.gap - deepest.mm) / out.norm();
    part(i, holders(i, deepest.first_triangle, deepest.on_first), j,
         holders(j, deepest.second_triangle, deepest.on_second), out);
  }

  /// Vertices of a that lie in b, or nearly.
  void ask_at_vertices(std::size_t a, std::size_t b) {
    const std::vector<Point>& vertices = pressed_.meshes[a].vertices;
    const ClosedBox& box = surfaces_[b]->box();
    std::vector<std::optional<SignedDistance>> nearest(vertices.size());
    tbb::parallel_for(std::size_t{0}, vertices.size(), [&](std::size_t v) {
      const std::array<double, 3> p{vertices[v].x(), vertices[v].y(), vertices[v].z()};
      if (box.squared_gap({p, p}) < options_.gap * options_.gap)
        nearest[v] = surfaces_[b]->signed_distance(vertices[v], options_.gap);
    });
    for (std::size_t v = 0; v < vertices.size(); ++v) {
      const std::optional<SignedDistance>& near = nearest[v];
      if (!near || near->mm >= options_.gap) continue;
      Eigen::Vector3d out = near->mm < 0 ? near->on_surface - vertices[v] : vertices[v] - near->on_surface;
      if (out.norm() < 1e-9) out = triangle_normal(pressed_.meshes[b], at(near->triangle));
      out *= (options_.gap - near->mm) / out.norm();
      part(a, {static_cast<int>(v)}, b, holders(b, near->triangle, near->on_surface), out);
    }
  }

  /// Asks vertices of a and of b to part by `out`, by which a's go: either by half, or one wholly where the other's are
  /// scanned.
  void part(std::size_t a, const std::vector<int>& of_a, std::size_t b, const std::vector<int>& of_b,
            const Eigen::Vector3d& out) {
    const auto any_moves = [&](std::size_t tooth, const std::vector<int>& vertices) {
      return std::any_of(vertices.begin(), vertices.end(), [&](int v) { return may_move(tooth, v); });
    };
    const double share = any_moves(a, of_a) && any_moves(b, of_b) ? 0.5 : 1;
    for (const int v : of_a)
      if (may_move(a, v)) add(missing_[a][at(v)], share * out);
    for (const int v : of_b)
      if (may_move(b, v)) add(missing_[b][at(v)], -share * out);
  }

  /// The longer of two ways.
  static void add(std::optional<Eigen::Vector3d>& way, const Eigen::Vector3d& other) {
    if (!way || other.squaredNorm() > way->squaredNorm()) way = other;
  }

  /// Moves what is asked of a tooth, and what was asked of it before. False if nothing moves.
  bool give_way(std::size_t i) {
    const TriangleMesh& before = teeth_[i].mesh;
    TriangleMesh& now = pressed_.meshes[i];
    std::vector<int> asked;
    bool any = false;
    for (std::size_t v = 0; v < wishes_[i].size(); ++v) {
      if (missing_[i].size() > v && missing_[i][v]) {
        Eigen::Vector3d whole = now.vertices[v] - before.vertices[v] + *missing_[i][v];
        if (whole.norm() > options_.most) whole *= options_.most / whole.norm();
        wishes_[i][v] = whole;
        any = true;
      }
      if (wishes_[i][v]) asked.push_back(static_cast<int>(v));
    }
    if (!any) return false;
    TriangleMesh moved = with_wishes(i, asked);
    if (moved.vertices == now.vertices) return false;
    now = std::move(moved);
    pressed_.largest_mm[i] = 0;
    for (std::size_t v = 0; v < now.vertices.size(); ++v)
      pressed_.largest_mm[i] = std::max(pressed_.largest_mm[i], (now.vertices[v] - before.vertices[v]).norm());
    return true;
  }

  TriangleMesh with_wishes(std::size_t i, const std::vector<int>& asked) const {
    // A wish weighs as much as curvature over a sixth of a millimetre, so that the surface comes to it.
    constexpr double weight = 1000;  // mm^-4
    constexpr double step = 1.0 / 4096;
    const TriangleMesh& before = teeth_[i].mesh;
    const std::vector<double> distance = distances_along_edges(before, asked, options_.reach);
    std::vector<int> free;
    Wishes wishes;
    for (std::size_t v = 0; v < distance.size(); ++v) {
      if (!std::isfinite(distance[v]) || !may_move(i, static_cast<int>(v))) continue;
      free.push_back(static_cast<int>(v));
      wishes.push_back(wishes_[i][v]);
    }
    const Eigen::MatrixXd displacements = smoothest_displacements(before, free, wishes, weight);
    if (displacements.rows() == 0) return pressed_.meshes[i];
    Eigen::MatrixXd targets(displacements.rows(), 3);
    for (std::size_t k = 0; k < free.size(); ++k) {
      const auto row = static_cast<Eigen::Index>(k);
      Eigen::RowVector3d way = displacements.row(row);
      // Between wishes the smooth surface may go beyond them; less a step, for ways are rounded.
      if (const double longest = options_.most - step; way.norm() > longest) way *= longest / way.norm();
      targets.row(row) = before.vertices[at(free[k])].transpose() + step * (way / step).array().round().matrix();
    }
    SafelyMoved moved = move_safely(teeth_[i], free, targets);
    if (moved.cuts_itself) return pressed_.meshes[i];
    return std::move(moved.mesh);
  }

  const std::vector<JoinedTooth>& teeth_;
  PressOptions options_;
  PressedTeeth pressed_;
  std::vector<std::unique_ptr<const SolidSurface>> surfaces_;
  std::map<ToothPair, double> depth_;  // mm, before the last round
  std::vector<Wishes> wishes_;         // of all rounds, from where the vertices were
  std::vector<Wishes> missing_;        // of this round, from where they are
};

}  // namespace

void require_options_in_range(const PressOptions& options) {
  require_ranges("pressing apart", {{"gap", options.gap, OptionRange::above(0).at_most(0.5)},
                                    {"most", options.most, OptionRange::above(0).at_most(2)},
                                    {"reach", options.reach, OptionRange::above(0)},
                                    {"rounds", options.rounds, OptionRange::at_least(1)}});
}

PressedTeeth press_apart(const std::vector<JoinedTooth>& teeth, const PressOptions& options) {
  require_options_in_range(options);
  return Pressing(teeth, options).run();
}

}  // namespace rhizodont
