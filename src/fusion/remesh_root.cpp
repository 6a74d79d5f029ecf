// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// L. Chen, "Mesh smoothing schemes based on optimal Delaunay triangulations", 2004: a vertex moves to the mean of the
//   circumcentres around it, weighted by area and density; next to centroidal Voronoi diagrams this avoids slivers.
// M. Botsch and L. Kobbelt, "A remeshing approach to multiresolution modeling", 2004: split, collapse, flip, relax.

#include "fusion/remesh_root.hpp"

#include "base/option_range.hpp"
#include "fusion/fitted_patch.hpp"
#include "fusion/mend_angles.hpp"
#include "mesh/at.hpp"

#include <Eigen/Geometry>

#include <cmath>
#include <numbers>

namespace rhizodont {
namespace {

/// Opposite angles sum to more than pi.
bool is_not_delaunay(const FittedPatch& patch, int h) {
  const PatchMesh& mesh = patch.mesh();
  const Point &a = patch.point(mesh.from(h)), &b = patch.point(mesh.to(h));
  const Point &c = patch.point(mesh.apex(h)), &d = patch.point(mesh.apex(mesh.opposite(h)));
  const Eigen::Vector3d ca = a - c, cb = b - c, da = a - d, db = b - d;
  const double cos_c = ca.dot(cb), sin_c = ca.cross(cb).norm();
  const double cos_d = da.dot(db), sin_d = da.cross(db).norm();
  const double slack = 1e-9 * (std::abs(sin_c * cos_d) + std::abs(cos_c * sin_d));
  return sin_c * cos_d + cos_c * sin_d < -slack;
}

int flip_to_delaunay(FittedPatch& patch) {
  const PatchMesh& mesh = patch.mesh();
  std::vector<int> stack;
  std::vector<char> waits(at(mesh.half_edges()), 0);
  const auto push = [&](int h) {
    if (mesh.opposite(h) < 0 || waits[at(h)]) return;
    waits[at(h)] = 1;
    stack.push_back(h);
  };
  for (int h = 0; h < mesh.half_edges(); ++h)
    if (mesh.is_alive(h) && mesh.opposite(h) > h) push(h);
  // On a bent surface flips need not come to an end.
  std::size_t allowed = 10 * stack.size();
  int flips = 0;
  while (!stack.empty() && allowed-- > 0) {
    const int h = stack.back();
    stack.pop_back();
    waits[at(h)] = 0;
    if (mesh.opposite(h) < 0 || !is_not_delaunay(patch, h) || !patch.can_flip(h)) continue;
    patch.flip(h);
    ++flips;
    for (const int k : {h, mesh.opposite(h)}) {
      push(PatchMesh::next(k));
      push(PatchMesh::previous(k));
    }
  }
  return flips;
}

int split_long_edges(FittedPatch& patch, double longest) {
  int splits = 0;
  const int end = patch.mesh().half_edges();
  for (int h = 0; h < end; ++h) {
    if (!patch.mesh().is_alive(h) || patch.mesh().opposite(h) < h) continue;
    if (patch.relative_length(h) <= longest || !patch.can_split(h)) continue;
    patch.split(h);
    ++splits;
  }
  return splits;
}

int collapse_short_edges(FittedPatch& patch, double shortest) {
  int collapses = 0;
  for (int h = 0; h < patch.mesh().half_edges(); ++h) {
    if (!patch.mesh().is_alive(h) || patch.mesh().opposite(h) < 0) continue;
    if (patch.relative_length(h) >= shortest || !patch.can_collapse(h)) continue;
    patch.collapse(h);
    ++collapses;
  }
  return collapses;
}

/// The circumcentre, or where the angle opposite to the longest side is obtuse, the middle of that side.
Point bounded_circumcentre(const Point& a, const Point& b, const Point& c) {
  const double la = (b - c).squaredNorm(), lb = (c - a).squaredNorm(), lc = (a - b).squaredNorm();
  const double wa = la * (lb + lc - la), wb = lb * (lc + la - lb), wc = lc * (la + lb - lc);
  if (wa <= 0) return 0.5 * (b + c);
  if (wb <= 0) return 0.5 * (c + a);
  if (wc <= 0) return 0.5 * (a + b);
  return (wa * a + wb * b + wc * c) / (wa + wb + wc);
}

void relax(FittedPatch& patch) {
  const PatchMesh& mesh = patch.mesh();
  std::vector<Point> sum(mesh.points.size(), Point::Zero());
  std::vector<double> weight(mesh.points.size(), 0);
  for (int h = 0; h < mesh.half_edges(); h += 3) {
    if (!mesh.is_alive(h)) continue;
    const std::array<int, 3> v{mesh.from(h), mesh.from(h + 1), mesh.from(h + 2)};
    const Point &a = patch.point(v[0]), &b = patch.point(v[1]), &c = patch.point(v[2]);
    const double size = (patch.size(v[0]) + patch.size(v[1]) + patch.size(v[2])) / 3;
    const double w = (b - a).cross(c - a).norm() / std::pow(size, 4);
    const Point centre = bounded_circumcentre(a, b, c);
    for (const int i : v) {
      sum[at(i)] += w * centre;
      weight[at(i)] += w;
    }
  }
  for (int v = mesh.fixed_vertices(); v < static_cast<int>(mesh.points.size()); ++v) {
    if (mesh.leaving(v) < 0 || !(weight[at(v)] > 0)) continue;
    const SurfacePlace place = patch.fit(v, sum[at(v)] / weight[at(v)]);
    if (patch.can_move(v, place)) patch.move(v, place);
  }
}

/// No angle is smaller than wanted in the interior or along the border.
bool smallest_angles_suffice(const FittedPatch& patch, const RemeshRootOptions& options) {
  const PatchMesh& mesh = patch.mesh();
  for (int h = 0; h < mesh.half_edges(); h += 3) {
    if (!mesh.is_alive(h)) continue;
    const bool at_border = mesh.is_fixed(mesh.from(h)) || mesh.is_fixed(mesh.to(h)) || mesh.is_fixed(mesh.apex(h));
    const double bound = at_border ? options.border_angle : options.inner_angle;
    if (patch.smallest_angle_at(h) < bound * std::numbers::pi / 180) return false;
  }
  return true;
}

}  // namespace

void require_in_range(const RemeshRootOptions& options) {
  require_ranges("remeshing", {{"iterations", options.iterations, OptionRange::at_least(0)},
                               {"longest", options.longest, OptionRange::above(1)},
                               {"shortest", options.shortest, OptionRange::above(0).below(1)},
                               {"fading", options.fading, OptionRange::above(0)},
                               {"least_angle", options.least_angle, OptionRange::at_least(0).at_most(30)},
                               {"mending_rounds", options.mending_rounds, OptionRange::at_least(0)},
                               {"inner_angle", options.inner_angle, OptionRange::at_least(0).at_most(30)},
                               {"border_angle", options.border_angle, OptionRange::at_least(0).at_most(30)},
                               {"mending_passes", options.mending_passes, OptionRange::at_least(0)},
                               {"mending_splits", options.mending_splits, OptionRange::at_least(0)},
                               {"mending_places", options.mending_places, OptionRange::at_least(0)}});
}

RootRemeshing remesh_root(JoinedTooth& tooth, const SurfaceWalk& guiding_surface, const EdgeLengths& lengths,
                          const std::vector<Point>& frozen_centres, double frozen_radius,
                          const RemeshRootOptions& options) {
  require_in_range(options);
  FittedPatch patch(tooth, guiding_surface, lengths);
  const auto triangles = static_cast<double>(tooth.mesh.triangles.size()) - tooth.crown_triangles;
  patch.freeze(frozen_centres, frozen_radius);
  RootRemeshing done;
  for (int i = 0; i < options.iterations; ++i) {
    if (i < (options.iterations + 1) / 2) {
      done.splits += split_long_edges(patch, options.longest);
      done.collapses += collapse_short_edges(patch, options.shortest);
    }
    done.flips += flip_to_delaunay(patch);
    patch.renew_offsets(options.fading);
    relax(patch);
    patch.renew_sizes();
  }
  done.flips += flip_to_delaunay(patch);
  constexpr double radians = std::numbers::pi / 180;
  MendingBudget budget{static_cast<std::int64_t>(options.mending_splits * triangles),
                       static_cast<std::int64_t>(options.mending_places * triangles)};
  for (int i = 0; i < options.mending_passes; ++i) {
    done.mended += mend_angles(patch, options.least_angle * radians, options.mending_rounds, budget);
    if (smallest_angles_suffice(patch, options)) break;
    // Triangles that touch the crown have less to promise: what they can spare is given to those beside them.
    done.mended += mend_angles(patch, 1.1 * options.inner_angle * radians, options.mending_rounds, budget,
                               options.inner_angle / options.border_angle);
    if (smallest_angles_suffice(patch, options)) break;
    // What no single operation mends may be mended from a slightly different start.
    if (i + 1 < options.mending_passes) {
      relax(patch);
      patch.renew_sizes();
      done.flips += flip_to_delaunay(patch);
    }
  }
  tooth.mesh = patch.tooth(tooth);
  return done;
}

}  // namespace rhizodont
