// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// "Completing Dental Models While Preserving Crown Geometry and Meshing Topology", sections 3.5 and 3.6.

#include "fusion/fuse.hpp"

#include "mesh/diagnosis.hpp"
#include "mesh/self_intersection.hpp"
#include "rhizodont/error.hpp"

#include <fmt/format.h>

namespace rhizodont {
namespace {

bool is_sound(const TriangleMesh& mesh) {
  return diagnose(mesh).is_closed_solid() && self_intersecting_triangles(mesh).empty();
}

FusedTooth attempt(const TriangleMesh& crown, const TriangleMesh& guiding_surface, const Eigen::Vector3d& growth_axis,
                   const FuseOptions& options, const SeparationOptions& separation_options) {
  FusedTooth fused;
  fused.separation = separate_crown_and_root(guiding_surface, crown, growth_axis, separation_options);
  std::vector<Point> root;
  for (std::size_t v = 0; v < guiding_surface.vertices.size(); ++v)
    if (fused.separation.is_root[v]) root.push_back(guiding_surface.vertices[v]);
  const Joining joining = join_crown_and_root(crown, root, guiding_surface, options.join);
  fused.crown_triangles_direct = joining.crown_triangles_direct;
  fused.steiner_points = joining.steiner_points;
  fused.tooth = restore_crown(crown, joining, options.restore);
  if (!is_sound(fused.tooth.mesh)) throw NoResultError("Crown and root together do not form a solid of one piece.");

  RestoredTooth remeshed = fused.tooth;
  remesh_band(remeshed, options.remesh);
  if (is_sound(remeshed.mesh))
    fused.tooth = std::move(remeshed);
  else
    fused.warnings.push_back("The triangles beside the crown's border could not be improved.");
  fused.transition = smooth_transition(fused.tooth, options.transition);
  if (fused.transition.applied < 1)
    fused.warnings.push_back(
        fmt::format("The seam between crown and root was smoothed to {:.0f} % only.", 100 * fused.transition.applied));
  return fused;
}

}  // namespace

FusedTooth fuse_crown_and_root(const TriangleMesh& crown, const TriangleMesh& guiding_surface,
                               const Eigen::Vector3d& growth_axis, const FuseOptions& options) {
  SeparationOptions separation = options.separation;
  std::vector<std::string> failures;
  for (int i = 1;; ++i) {
    try {
      FusedTooth fused = attempt(crown, guiding_surface, growth_axis, options, separation);
      for (const std::string& sentence : failures)
        fused.warnings.push_back("The root was started farther from the crown's border: " + sentence);
      return fused;
    } catch (const NoResultError& error) {
      if (i >= options.attempts) throw;
      failures.emplace_back(error.what());
    }
    separation.clearance = 1.6 * separation.clearance + 0.4;
  }
}

}  // namespace rhizodont
