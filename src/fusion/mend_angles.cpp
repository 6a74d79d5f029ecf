// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "fusion/mend_angles.hpp"

#include "mesh/at.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <utility>
#include <vector>

namespace rhizodont {
namespace {

constexpr double worthwhile = 1e-3;  // radians by which an operation has to improve the smallest angle

class Mender {
 public:
  Mender(FittedPatch& patch, double crown_weight, MendingBudget& budget)
      : patch_(patch),
        crown_weight_(crown_weight),
        budget_(budget),
        changed_(patch.mesh().points.size(), 0),
        given_up_(at(patch.mesh().half_edges() / 3)) {}

  /// Works on the triangles with an angle below the bound, worst first; returns the number of operations.
  int round(double bound) {
    std::vector<std::pair<double, int>> bad;
    for (int h = 0; h < mesh().half_edges(); h += 3) {
      if (!mesh().is_alive(h)) continue;
      const double angle = angle_at(h);
      if (angle < bound) bad.emplace_back(angle, h);
    }
    std::sort(bad.begin(), bad.end());
    int done = 0;
    for (const auto& [angle, h] : bad)
      if (budget_.places > 0 && mesh().is_alive(h) && angle_at(h) < bound && improve(h)) ++done;
    return done;
  }

 private:
  /// A triangle that could not be improved: after which change, and how many places were tried.
  struct GivenUp {
    int change = -1;
    std::int64_t places = 0;
  };

  const PatchMesh& mesh() const { return patch_.mesh(); }

  bool improve(int h) {
    if (GivenUp& given_up = given_up_[at(h / 3)]; is_as_it_was(h, given_up)) {
      budget_.places -= given_up.places;  // as if they were tried again
      return false;
    }
    const std::int64_t places = budget_.places;
    if (improve_by_flip(h) || improve_by_collapse(h) || improve_by_moves(h) || improve_by_split(h)) return true;
    given_up_[at(h / 3)] = {changes_, places - budget_.places};
    return false;
  }

  /// Nothing has changed since about the triangle and those over its edges: whatever would be tried fails again.
  bool is_as_it_was(int h, const GivenUp& given_up) const {
    if (given_up.change < 0) return false;
    for (const int k : {h, PatchMesh::next(h), PatchMesh::previous(h)}) {
      if (changed_[at(mesh().from(k))] > given_up.change) return false;
      const int over = mesh().opposite(k);
      if (over >= 0 && changed_[at(mesh().apex(over))] > given_up.change) return false;
    }
    return true;
  }

  /// Notes that the triangles around these vertices have changed, or will now.
  void note_change(std::initializer_list<int> vertices) {
    ++changes_;
    for (const int v : vertices) changed_[at(v)] = changes_;
  }
  void note_change_around(int v) {
    note_change({v});
    for (const int w : mesh().neighbours(v)) changed_[at(w)] = changes_;
  }

  void flip(int h) {
    note_change({mesh().from(h), mesh().to(h), mesh().apex(h), mesh().apex(mesh().opposite(h))});
    patch_.flip(h);
  }

  void collapse(int h) {
    note_change_around(mesh().from(h));
    patch_.collapse(h);
  }

  void move(int v, const SurfacePlace& place) {
    patch_.move(v, place);
    note_change_around(v);
  }

  void split(int h) {
    note_change({mesh().from(h), mesh().to(h), mesh().apex(h), mesh().apex(mesh().opposite(h))});
    patch_.split(h);
    changed_.resize(mesh().points.size(), changes_);
    given_up_.resize(at(mesh().half_edges() / 3));
  }

  double weight(int a, int b, int c) const {
    return mesh().is_fixed(a) || mesh().is_fixed(b) || mesh().is_fixed(c) ? crown_weight_ : 1;
  }

  /// Weighted smallest angle of a triangle of these vertices, with the first of them at p.
  double angle_of(int a, const Point& p, int b, int c) const {
    return weight(a, b, c) * smallest_angle(p, patch_.point(b), patch_.point(c));
  }

  double angle_of(int a, int b, int c) const { return angle_of(a, patch_.point(a), b, c); }

  double angle_at(int h) const { return angle_of(mesh().from(h), mesh().to(h), mesh().apex(h)); }

  double smallest_around(int v) const {
    double smallest = 4 * crown_weight_;
    mesh().around(v, [&](int h) { smallest = std::min(smallest, angle_at(h)); });
    return smallest;
  }

  /// Gain in smallest angle that turning the edge would bring; negative if it cannot be turned.
  double flip_gain(int h) const {
    if (!patch_.can_flip(h)) return -1;
    const int g = mesh().opposite(h);
    const int a = mesh().from(h), b = mesh().to(h), c = mesh().apex(h), d = mesh().apex(g);
    return std::min(angle_of(d, c, a), angle_of(c, d, b)) - std::min(angle_of(a, b, c), angle_of(b, a, d));
  }

  bool improve_by_flip(int h) {
    int best = -1;
    double best_gain = worthwhile;
    for (const int k : {h, PatchMesh::next(h), PatchMesh::previous(h)}) {
      const double gain = flip_gain(k);
      if (gain <= best_gain) continue;
      best = k;
      best_gain = gain;
    }
    if (best >= 0) flip(best);
    return best >= 0;
  }

  bool improve_by_collapse(int h) {
    int best = -1;
    double best_gain = worthwhile;
    for (const int k : {h, PatchMesh::next(h), PatchMesh::previous(h)})
      for (const int way : {k, mesh().opposite(k)}) {
        if (way < 0 || patch_.relative_length(way) > 1 || !patch_.can_collapse(way)) continue;
        const double gain = smallest_after_collapse(way) - smallest_around(mesh().from(way));
        if (gain <= best_gain) continue;
        best = way;
        best_gain = gain;
      }
    if (best >= 0) collapse(best);
    return best >= 0;
  }

  double smallest_after_collapse(int h) const {
    const int v = mesh().to(h);
    double smallest = 4 * crown_weight_;
    mesh().around(mesh().from(h), [&](int k) {
      const int b = mesh().to(k), c = mesh().apex(k);
      if (b != v && c != v) smallest = std::min(smallest, angle_of(v, b, c));
    });
    return smallest;
  }

  /// Moves a free corner of the triangle to the best of a few places about it.
  bool improve_by_moves(int h) {
    bool moved = false;
    for (const int k : {h, PatchMesh::next(h), PatchMesh::previous(h)}) {
      const int v = mesh().from(k);
      if (mesh().is_fixed(v)) continue;
      for (double step = 0.4; step > 0.03; step *= 0.5)
        while (budget_.places > 0 && improve_by_move(v, step * patch_.size(v))) moved = true;
    }
    return moved;
  }

  bool improve_by_move(int v, double step) {
    int worst = -1;  // the triangle with the smallest angle: most places fail there already
    double before = 4 * crown_weight_;
    mesh().around(v, [&](int h) {
      const double angle = angle_at(h);
      if (angle >= before) return;
      before = angle;
      worst = h;
    });
    SurfacePlace best;
    double best_angle = before + worthwhile;
    // The edges of v serve as directions; they and their opposites cover the tangent plane.
    const Point here = patch_.point(v);
    const std::vector<int> neighbours = mesh().neighbours(v);
    for (const int w : neighbours)
      for (const double sign : {1.0, -1.0}) {
        const Eigen::Vector3d along = patch_.point(w) - here;
        const double length = along.norm();
        if (!(length > 0)) continue;
        --budget_.places;
        const SurfacePlace place = patch_.fit(v, here + sign * std::min(step / length, 0.5) * along);
        const auto angle_after = [&](int k) { return angle_of(v, place.point, mesh().to(k), mesh().apex(k)); };
        double smallest = angle_after(worst);
        mesh().around(v, [&](int k) {
          if (smallest > best_angle && k != worst) smallest = std::min(smallest, angle_after(k));
        });
        if (smallest <= best_angle || !patch_.can_move(v, place)) continue;
        best_angle = smallest;
        best = place;
      }
    if (best.triangle < 0) return false;
    move(v, best);
    return true;
  }

  /// Splits the longest edge where the two new vertices beside it would see better angles, and always where it joins
  /// two border vertices: without a vertex of its own such a triangle has the border's angles.
  bool improve_by_split(int h) {
    if (budget_.splits <= 0) return false;
    int longest = -1;
    double length = 0;
    for (const int k : {h, PatchMesh::next(h), PatchMesh::previous(h)}) {
      const double l = (patch_.point(mesh().from(k)) - patch_.point(mesh().to(k))).norm();
      if (l <= length) continue;
      longest = k;
      length = l;
    }
    if (longest < 0 || !patch_.can_split(longest)) return false;
    const int a = mesh().from(longest), b = mesh().to(longest);
    if (!(mesh().is_fixed(a) && mesh().is_fixed(b))) {
      const int g = mesh().opposite(longest);
      const Point middle = 0.5 * (patch_.point(a) + patch_.point(b));
      double after = 4 * crown_weight_;
      for (const int apex : {mesh().apex(longest), mesh().apex(g)})
        for (const int end : {a, b}) {
          const double touching = mesh().is_fixed(apex) || mesh().is_fixed(end) ? crown_weight_ : 1;
          after = std::min(after, touching * smallest_angle(middle, patch_.point(end), patch_.point(apex)));
        }
      if (after < std::min(angle_at(longest), angle_at(g)) + worthwhile) return false;
    }
    split(longest);
    --budget_.splits;
    return true;
  }

  FittedPatch& patch_;
  double crown_weight_;
  MendingBudget& budget_;
  int changes_ = 0;                // flips, collapses, moves and splits so far
  std::vector<int> changed_;       // per vertex the last of them that concerned a triangle around it
  std::vector<GivenUp> given_up_;  // per triangle
};

}  // namespace

int mend_angles(FittedPatch& patch, double least_angle, int rounds, MendingBudget& budget, double crown_weight) {
  Mender mender(patch, crown_weight, budget);
  int done = 0;
  for (int round = 0; round < rounds; ++round) {
    const int now = mender.round(least_angle);
    done += now;
    if (now == 0) break;
  }
  return done;
}

}  // namespace rhizodont
