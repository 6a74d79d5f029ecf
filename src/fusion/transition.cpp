// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// "Completing Dental Models While Preserving Crown Geometry and Meshing Topology", section 3.6: transition
// optimisation. M. Botsch and L. Kobbelt, "An intuitive framework for real-time freeform modeling", 2004: boundary
// conditions of higher order by fixing vertices on both sides of the band.

#include "fusion/transition.hpp"

#include "base/option_range.hpp"
#include "fusion/biharmonic.hpp"
#include "fusion/safe_moves.hpp"
#include "mesh/edge_distance.hpp"
#include "mesh/self_intersection.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace rhizodont {
namespace {

double border_edge_length(const JoinedTooth& tooth) {
  double sum = 0;
  int count = 0;
  for (std::size_t t = static_cast<std::size_t>(tooth.crown_triangles); t < tooth.mesh.triangles.size(); ++t) {
    const Triangle& tri = tooth.mesh.triangles[t];
    for (std::size_t i = 0; i < 3; ++i) {
      const int a = tri[i], b = tri[(i + 1) % 3];
      if (a >= tooth.crown_vertices || b >= tooth.crown_vertices) continue;
      sum +=
          (tooth.mesh.vertices[static_cast<std::size_t>(a)] - tooth.mesh.vertices[static_cast<std::size_t>(b)]).norm();
      ++count;
    }
  }
  return count > 0 ? sum / count : 0;
}

double chosen_width(const JoinedTooth& tooth, const TransitionOptions& options) {
  if (options.width) return *options.width;
  return std::clamp(std::max(options.gap / options.slope, options.rows * border_edge_length(tooth)),
                    options.least_width, options.largest_width);
}

}  // namespace

void require_in_range(const TransitionOptions& options) {
  if (options.width) require_ranges("the transition", {{"width", *options.width, OptionRange::at_least(0)}});
  require_ranges("the transition",
                 {{"gap", options.gap, OptionRange::at_least(0)},
                  {"slope", options.slope, OptionRange::above(0)},
                  {"rows", options.rows, OptionRange::above(0)},
                  {"least_width", options.least_width, OptionRange::at_least(0)},
                  {"largest_width", options.largest_width, OptionRange::at_least(options.least_width)},
                  {"inner_angle", options.inner_angle, OptionRange::at_least(0).at_most(30)},
                  {"border_angle", options.border_angle, OptionRange::at_least(0).at_most(30)},
                  {"cut_rounds", options.cut_rounds, OptionRange::at_least(1)}});
}

Transition smooth_transition(JoinedTooth& tooth, const TransitionOptions& options) {
  require_in_range(options);
  Transition result;
  result.width = chosen_width(tooth, options);
  const auto crown_triangles = static_cast<std::size_t>(tooth.crown_triangles);
  std::vector<int> crown(static_cast<std::size_t>(tooth.crown_vertices));
  std::iota(crown.begin(), crown.end(), 0);
  const auto distance = distances_along_edges(tooth.mesh, crown, result.width);
  for (std::size_t v = static_cast<std::size_t>(tooth.crown_vertices); v < distance.size(); ++v)
    if (std::isfinite(distance[v])) result.vertices.push_back(static_cast<int>(v));
  const Eigen::MatrixXd target =
      result.vertices.empty() ? Eigen::MatrixXd{} : biharmonic_positions(tooth.mesh, result.vertices);
  if (target.rows() == 0) {
    result.applied = result.vertices.empty() ? 1 : 0;
    result.cuts_itself = !self_intersecting_triangles(tooth.mesh, crown_triangles).empty();
    return result;
  }
  SafelyMoved moved =
      move_safely(tooth, result.vertices, target, {options.inner_angle, options.border_angle, options.cut_rounds});
  result.cuts_itself = moved.cuts_itself;
  for (const int v : result.vertices) {
    const auto i = static_cast<std::size_t>(v);
    result.largest_move = std::max(result.largest_move, (moved.mesh.vertices[i] - tooth.mesh.vertices[i]).norm());
  }
  result.applied = moved.applied;
  tooth.mesh = std::move(moved.mesh);
  return result;
}

}  // namespace rhizodont
