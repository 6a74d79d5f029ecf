// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "fusion/safe_moves.hpp"

#include "fusion/fitted_patch.hpp"
#include "mesh/geometry.hpp"
#include "mesh/self_intersection.hpp"

#include <algorithm>
#include <numbers>

namespace rhizodont {
namespace {

/// Displacements with the share of each that is applied.
class SafeMoves {
 public:
  SafeMoves(const JoinedTooth& tooth, const std::vector<int>& vertices, const Eigen::MatrixXd& target,
            const SafeMoveOptions& options)
      : before_(tooth.mesh),
        crown_vertices_(tooth.crown_vertices),
        vertices_(vertices),
        target_(target),
        options_(options),
        share_(tooth.mesh.vertices.size(), 0) {
    for (const int v : vertices) share_[static_cast<std::size_t>(v)] = 1;
    for (std::size_t t = static_cast<std::size_t>(tooth.crown_triangles); t < before_.triangles.size(); ++t)
      if (std::any_of(before_.triangles[t].begin(), before_.triangles[t].end(), [&](int v) { return moves(v); }))
        concerned_.push_back(t);
  }

  TriangleMesh moved() const {
    TriangleMesh mesh = before_;
    for (std::size_t i = 0; i < vertices_.size(); ++i) {
      const auto v = static_cast<std::size_t>(vertices_[i]);
      const Point target = target_.row(static_cast<Eigen::Index>(i)).transpose();
      if (moves(vertices_[i])) mesh.vertices[v] += share_[v] * (target - mesh.vertices[v]);
    }
    return mesh;
  }

  /// Lessens the moves about triangles that turn over or lose a good angle; true if there were any.
  bool restrain_bad_triangles(const TriangleMesh& after) {
    std::vector<int> corners;
    for (const std::size_t t : concerned_) {
      if (!is_spoilt(after, t)) continue;
      corners.insert(corners.end(), after.triangles[t].begin(), after.triangles[t].end());
    }
    return restrain(corners);
  }

  /// Lessens the moves about triangles that cut others; true if there were any that could be lessened.
  bool restrain_cuts(const TriangleMesh& after, const std::vector<std::pair<int, int>>& cuts) {
    std::vector<int> corners;
    for (const auto& [a, b] : cuts)
      for (const int t : {a, b})
        for (const int v : after.triangles[static_cast<std::size_t>(t)]) corners.push_back(v);
    return restrain(corners);
  }

  double mean_share() const {
    double sum = 0;
    for (const int v : vertices_) sum += share_[static_cast<std::size_t>(v)];
    return sum / static_cast<double>(vertices_.size());
  }

 private:
  bool moves(int v) const { return share_[static_cast<std::size_t>(v)] > 0; }

  bool restrain(std::vector<int> corners) {
    std::sort(corners.begin(), corners.end());
    corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
    bool any = false;
    for (const int v : corners) {
      if (!moves(v)) continue;
      double& share = share_[static_cast<std::size_t>(v)];
      share = share > 0.2 ? 0.5 * share : 0;
      any = true;
    }
    return any;
  }

  bool is_spoilt(const TriangleMesh& after, std::size_t t) const {
    if (triangle_normal(before_, t).dot(triangle_normal(after, t)) <= 0) return true;
    const Triangle& tri = after.triangles[t];
    const bool at_border = std::any_of(tri.begin(), tri.end(), [&](int v) { return v < crown_vertices_; });
    const double bound = (at_border ? options_.border_angle : options_.inner_angle) * std::numbers::pi / 180;
    const double now = angle_of(after, tri);
    return now < bound && now < angle_of(before_, tri);
  }

  static double angle_of(const TriangleMesh& mesh, const Triangle& t) {
    return smallest_angle(mesh.vertices[static_cast<std::size_t>(t[0])], mesh.vertices[static_cast<std::size_t>(t[1])],
                          mesh.vertices[static_cast<std::size_t>(t[2])]);
  }

  const TriangleMesh& before_;
  int crown_vertices_;
  const std::vector<int>& vertices_;
  const Eigen::MatrixXd& target_;
  const SafeMoveOptions& options_;
  std::vector<double> share_;  // per vertex of the tooth
  std::vector<std::size_t> concerned_;
};

}  // namespace

SafelyMoved move_safely(const JoinedTooth& tooth, const std::vector<int>& vertices, const Eigen::MatrixXd& targets,
                        const SafeMoveOptions& options) {
  const auto crown_triangles = static_cast<std::size_t>(tooth.crown_triangles);
  SafeMoves moves(tooth, vertices, targets, options);
  SafelyMoved result;
  result.mesh = moves.moved();
  // Each pass takes some moves back, so this ends; where nothing can be lessened the cut was there before.
  for (int round = 1;; ++round) {
    while (moves.restrain_bad_triangles(result.mesh)) result.mesh = moves.moved();
    const auto cuts = self_intersecting_triangles(result.mesh, crown_triangles);
    result.cuts_itself = !cuts.empty();
    if (cuts.empty() || round >= options.cut_rounds || !moves.restrain_cuts(result.mesh, cuts)) break;
    result.mesh = moves.moved();
  }
  result.applied = moves.mean_share();
  return result;
}

}  // namespace rhizodont
