// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// "Completing Dental Models While Preserving Crown Geometry and Meshing Topology", sections 3.5 and 3.6.

#include "fusion/fuse.hpp"

#include "base/option_range.hpp"
#include "base/stopwatch.hpp"
#include "mesh/diagnosis.hpp"
#include "mesh/geometry.hpp"
#include "mesh/self_intersection.hpp"
#include "rhizodont/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

namespace rhizodont {
namespace {

double border_gap(const TriangleMesh& crown, const CrownBorder& border, const SurfaceWalk& walk) {
  std::vector<double> distances;
  for (const auto& [v, next] : border.half_edges) {
    const Point& p = crown.vertices[static_cast<std::size_t>(v)];
    distances.push_back((walk.closest(p, walk.triangle_near(p)).point - p).norm());
  }
  const auto rank = distances.begin() + static_cast<std::ptrdiff_t>(0.95 * static_cast<double>(distances.size()));
  std::nth_element(distances.begin(), rank, distances.end());
  return *rank;
}

/// What all attempts share.
struct Ground {
  const TriangleMesh& crown;
  const CrownBorder& border;
  const TriangleMesh& surface;
  const Eigen::Vector3d& growth_axis;
  DelaunayMesh delaunay;  // of the crown
  CrownDistances distances;
  SurfaceWalk walk;
  EdgeLengths lengths;
  double gap;  // mm, how far the guiding surface misses the border: exceeded by a twentieth of its vertices

  Ground(const PreparedCrown& prepared, const TriangleMesh& guiding_surface, const Eigen::Vector3d& axis,
         const FuseOptions& options)
      : crown(prepared.mesh),
        border(prepared.border),
        surface(guiding_surface),
        growth_axis(axis),
        delaunay(make_delaunay_mesh(crown, options.join.delaunay)),
        distances(crown_distances(surface, prepared)),
        walk(surface),
        lengths(edge_lengths(options.edge_growth, options)),
        gap(border_gap(crown, border, walk)) {}

  EdgeLengths edge_lengths(double growth, const FuseOptions& options) const {
    return {crown, border, mean_edge_length(surface), growth, options.edge_shrinkage};
  }
};

/// Positions of the vertices of new triangles that cut others.
std::vector<Point> cutting_points(const JoinedTooth& tooth, const std::vector<std::pair<int, int>>& cuts) {
  std::vector<Point> points;
  for (const auto& [a, b] : cuts)
    for (const int t : {a, b}) {
      if (t < tooth.crown_triangles) continue;
      for (const int v : tooth.mesh.triangles[static_cast<std::size_t>(t)])
        points.push_back(tooth.mesh.vertices[static_cast<std::size_t>(v)]);
    }
  return points;
}

/// Where the remeshed root makes the tooth cut itself, the triangles around are left as they were in `restored`.
void leave_cutting_triangles(const Ground& ground, const FuseOptions& options, const JoinedTooth& restored,
                             FusedTooth& fused) {
  std::vector<Point> frozen;
  for (int i = 1; i <= options.remesh_attempts; ++i) {
    const auto cuts = self_intersecting_triangles(fused.tooth.mesh, ground.crown.triangles.size());
    if (cuts.empty()) return;
    const std::vector<Point> more = cutting_points(fused.tooth, cuts);
    frozen.insert(frozen.end(), more.begin(), more.end());
    fused.tooth = restored;
    fused.remeshing = {};
    if (i == options.remesh_attempts) break;
    const double radius = (i + 1) * ground.lengths.root();
    fused.remeshing = remesh_root(fused.tooth, ground.walk, ground.lengths, frozen, radius, options.remesh);
  }
  fused.warnings.push_back("The root's triangles could not be improved.");
}

Joining join(const Ground& ground, const FuseOptions& options, const SeparationOptions& separation,
             FuseSeconds& spent) {
  Stopwatch watch;
  const auto is_root = separate_crown_and_root(ground.surface, ground.distances, ground.growth_axis, separation);
  spent.separation += watch.restart();
  const std::vector<Point> root =
      root_sites(ground.walk, is_root, ground.crown, ground.border, ground.lengths, options.sites);
  spent.sites += watch.restart();
  Joining joining = join_crown_and_root(ground.crown, ground.delaunay, root, ground.surface, options.join);
  spent.joining += watch.restart();
  return joining;
}

/// Smooths the remeshed tooth with one test for self-intersection at the end; nothing if it does not pass.
std::optional<FusedTooth> finished_at_once(const FusedTooth& remeshed, const TransitionOptions& transition,
                                           FuseSeconds& spent) {
  FusedTooth fused = remeshed;
  Stopwatch watch;
  TransitionOptions quick = transition;
  quick.cut_rounds = 1;
  fused.transition = smooth_transition(fused.tooth, quick);
  spent.transition += watch.restart();
  if (fused.transition.cuts_itself) return std::nullopt;
  return fused;
}

/// The same with a test after each step, so that the step that would break the tooth can be mended or left out.
FusedTooth finished_step_by_step(const Ground& ground, const JoinedTooth& restored, FusedTooth fused,
                                 const FuseOptions& options, const TransitionOptions& transition, FuseSeconds& spent) {
  Stopwatch watch;
  leave_cutting_triangles(ground, options, restored, fused);
  spent.remeshing += watch.restart();
  fused.transition = smooth_transition(fused.tooth, transition);
  spent.transition += watch.restart();
  if (fused.transition.cuts_itself) throw NoResultError("The tooth cuts itself at the seam.");
  return fused;
}

/// Remeshes the root and smooths the seam.
FusedTooth finished(const Ground& ground, const JoinedTooth& restored, const FuseOptions& options, FuseSeconds& spent) {
  TransitionOptions transition = options.transition;
  transition.gap = ground.gap;
  FusedTooth remeshed;
  remeshed.tooth = restored;
  Stopwatch watch;
  remeshed.remeshing = remesh_root(remeshed.tooth, ground.walk, ground.lengths, {}, 0, options.remesh);
  spent.remeshing += watch.restart();
  if (std::optional<FusedTooth> fused = finished_at_once(remeshed, transition, spent)) return *std::move(fused);
  return finished_step_by_step(ground, restored, std::move(remeshed), options, transition, spent);
}

/// One attempt's own tooth, its counts and its warnings; the time goes to the sum of all.
FusedTooth attempt(const Ground& ground, const FuseOptions& options, const SeparationOptions& separation,
                   FuseSeconds& spent) {
  const Joining joining = join(ground, options, separation, spent);
  Stopwatch watch;
  const JoinedTooth restored = restore_crown(ground.crown, joining, options.restore);
  spent.restoring += watch.restart();
  if (!diagnose(restored.mesh).is_closed_solid())
    throw NoResultError("Crown and root together do not form a solid of one piece.");
  FusedTooth fused = finished(ground, restored, options, spent);
  fused.root_sites = static_cast<int>(joining.sites.size()) - joining.crown_vertices - joining.steiner_points;
  fused.crown_triangles_direct = joining.crown_triangles_direct;
  fused.steiner_points = joining.steiner_points;
  fused.non_delaunay_edges_left = joining.non_delaunay_edges_left;
  fused.sites_without_cell = joining.sites_without_cell;
  fused.sharpest_notch = ground.border.sharpest_notch;
  if (fused.transition.applied < 0.9)
    fused.warnings.push_back(
        fmt::format("The seam between crown and root was smoothed to {:.0f} % only.", 100 * fused.transition.applied));
  return fused;
}

/// The smallest angle of new triangles relative to what is wanted there: 1 or more if it is reached everywhere. Those
/// between vertices of the crown alone fill its notches, and do not hang on how edges grow.
double least_angle_share(const JoinedTooth& tooth, const TransitionOptions& wanted) {
  double least = std::numeric_limits<double>::max();
  for (std::size_t t = static_cast<std::size_t>(tooth.crown_triangles); t < tooth.mesh.triangles.size(); ++t) {
    const Triangle& tri = tooth.mesh.triangles[t];
    const auto of_crown = std::count_if(tri.begin(), tri.end(), [&](int v) { return v < tooth.crown_vertices; });
    if (of_crown == 3) continue;
    const auto angles = triangle_angles(tooth.mesh, t);
    const double smallest = *std::min_element(angles.begin(), angles.end()) * 180 / std::numbers::pi;
    least = std::min(least, smallest / (of_crown > 0 ? wanted.border_angle : wanted.inner_angle));
  }
  return least;
}

/// Starts the root farther from the border until it can be joined.
FusedTooth fuse_on(const Ground& ground, const FuseOptions& options, FuseSeconds& spent) {
  SeparationOptions separation = options.separation;
  std::vector<std::string> failures;
  for (int i = 1;; ++i) {
    try {
      FusedTooth fused = attempt(ground, options, separation, spent);
      for (const std::string& sentence : failures)
        fused.warnings.push_back("The root was started farther from the crown's border: " + sentence);
      return fused;
    } catch (const NoResultError& error) {
      if (i >= options.attempts) throw;
      failures.emplace_back(error.what());
    }
    separation.clearance = 1.6 * separation.clearance + 0.15;
  }
}

void require_in_range(const FuseOptions& options) {
  constexpr OptionRange growth = OptionRange::above(0);
  require_ranges("joining crown and root", {{"edge_growth", options.edge_growth, growth},
                                            {"edge_shrinkage", options.edge_shrinkage, growth},
                                            {"attempts", options.attempts, OptionRange::at_least(1)},
                                            {"remesh_attempts", options.remesh_attempts, OptionRange::at_least(1)}});
  for (const double other : options.other_growths)
    require_ranges("joining crown and root", {{"other_growths", other, growth}});
  require_in_range(options.separation);
  require_in_range(options.sites);
  require_in_range(options.join);
  require_in_range(options.restore);
  require_in_range(options.remesh);
  require_in_range(options.transition);
}

}  // namespace

FusedTooth fuse_crown_and_root(const PreparedCrown& crown, const TriangleMesh& guiding_surface,
                               const Eigen::Vector3d& growth_axis, const FuseOptions& options) {
  assert(self_intersecting_triangles(crown.mesh).empty());
  require_in_range(options);
  FuseSeconds spent;
  Stopwatch watch;
  Ground ground(crown, guiding_surface, growth_axis, options);
  spent.separation += watch.restart();
  FusedTooth best = fuse_on(ground, options, spent);
  double share = least_angle_share(best.tooth, options.transition), last_share = share;
  constexpr int most_in_vain = 2;
  int in_vain = 0;
  for (const double growth : options.other_growths) {
    if (share >= 1 || in_vain == most_in_vain) break;
    ++in_vain;
    ground.lengths = ground.edge_lengths(growth, options);
    try {
      FusedTooth other = fuse_on(ground, options, spent);
      const double others = least_angle_share(other.tooth, options.transition);
      // To the last bit the same: that triangle does not hang on how edges grow.
      if (others == last_share) break;
      last_share = others;
      if (others <= share) continue;
      share = others;
      best = std::move(other);
      in_vain = 0;
    } catch (const NoResultError&) {
      // There is a tooth already; this was to make it better.
    }
  }
  best.seconds = spent;
  return best;
}

}  // namespace rhizodont
