// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// "Completing Dental Models While Preserving Crown Geometry and Meshing Topology", sections 3.5 and 3.6.

#include "fusion/fuse.hpp"

#include "fusion/crown_border.hpp"
#include "mesh/diagnosis.hpp"
#include "mesh/geometry.hpp"
#include "mesh/self_intersection.hpp"
#include "rhizodont/error.hpp"

#include <fmt/format.h>

#include <utility>

namespace rhizodont {
namespace {

/// What all attempts share.
struct Ground {
  const TriangleMesh& crown;
  const TriangleMesh& surface;
  const Eigen::Vector3d& growth_axis;
  CrownBorder border;
  CrownDistances distances;
  SurfaceWalk walk;
  EdgeLengths lengths;

  Ground(const TriangleMesh& the_crown, const TriangleMesh& guiding_surface, const Eigen::Vector3d& axis,
         const FuseOptions& options)
      : crown(the_crown),
        surface(guiding_surface),
        growth_axis(axis),
        border(find_crown_border(crown)),
        distances(crown_distances(surface, crown, border)),
        walk(surface),
        lengths(edge_lengths(crown, border, mean_edge_length(surface))) {
    lengths.growth = options.edge_growth;
    lengths.shrinkage = options.edge_shrinkage;
  }
};

/// Positions of the vertices of new triangles that cut others.
std::vector<Point> cutting_points(const RestoredTooth& tooth, const std::vector<std::pair<int, int>>& cuts) {
  std::vector<Point> points;
  for (const auto& [a, b] : cuts)
    for (const int t : {a, b}) {
      if (t < tooth.crown_triangles) continue;
      for (const int v : tooth.mesh.triangles[static_cast<std::size_t>(t)])
        points.push_back(tooth.mesh.vertices[static_cast<std::size_t>(v)]);
    }
  return points;
}

/// Remeshes the root; where that makes the tooth cut itself, the triangles around are left as they were.
void improve_triangles(const Ground& ground, const FuseOptions& options, FusedTooth& fused) {
  std::vector<Point> frozen;
  for (int i = 1; i <= options.remesh_attempts; ++i) {
    RestoredTooth remeshed = fused.tooth;
    const double radius = i * ground.lengths.root;
    const RootRemeshing done = remesh_root(remeshed, ground.walk, ground.lengths, frozen, radius, options.remesh);
    const auto cuts = self_intersecting_triangles(remeshed.mesh);
    if (cuts.empty()) {
      fused.tooth = std::move(remeshed);
      fused.remeshing = done;
      return;
    }
    const std::vector<Point> more = cutting_points(remeshed, cuts);
    frozen.insert(frozen.end(), more.begin(), more.end());
  }
  fused.warnings.push_back("The root's triangles could not be improved.");
}

FusedTooth attempt(const Ground& ground, const FuseOptions& options, const SeparationOptions& separation) {
  FusedTooth fused;
  const auto is_root = separate_crown_and_root(ground.surface, ground.distances, ground.growth_axis, separation);
  const std::vector<Point> root =
      root_sites(ground.walk, is_root, ground.crown, ground.border, ground.lengths, options.sites);
  fused.root_sites = static_cast<int>(root.size());
  const Joining joining = join_crown_and_root(ground.crown, root, ground.surface, options.join);
  fused.crown_triangles_direct = joining.crown_triangles_direct;
  fused.steiner_points = joining.steiner_points;
  fused.non_delaunay_edges_left = joining.non_delaunay_edges_left;
  fused.sites_without_cell = joining.sites_without_cell;
  fused.tooth = restore_crown(ground.crown, joining, options.restore);
  if (!diagnose(fused.tooth.mesh).is_closed_solid())
    throw NoResultError("Crown and root together do not form a solid of one piece.");
  improve_triangles(ground, options, fused);
  fused.transition = smooth_transition(fused.tooth, options.transition);
  if (fused.transition.applied < 1)
    fused.warnings.push_back(
        fmt::format("The seam between crown and root was smoothed to {:.0f} % only.", 100 * fused.transition.applied));
  return fused;
}

}  // namespace

FusedTooth fuse_crown_and_root(const TriangleMesh& crown, const TriangleMesh& guiding_surface,
                               const Eigen::Vector3d& growth_axis, const FuseOptions& options) {
  const Ground ground(crown, guiding_surface, growth_axis, options);
  SeparationOptions separation = options.separation;
  std::vector<std::string> failures;
  for (int i = 1;; ++i) {
    try {
      FusedTooth fused = attempt(ground, options, separation);
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

}  // namespace rhizodont
