// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// "Completing Dental Models While Preserving Crown Geometry and Meshing Topology", section 3.6: transition
// optimisation. M. Botsch and L. Kobbelt, "An intuitive framework for real-time freeform modeling", 2004: boundary
// conditions of higher order by fixing vertices on both sides of the band.

#include "fusion/transition.hpp"

#include "base/option_range.hpp"
#include "fusion/fitted_patch.hpp"
#include "mesh/edge_distance.hpp"
#include "mesh/geometry.hpp"
#include "mesh/self_intersection.hpp"

#include <Eigen/SparseCholesky>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace rhizodont {
namespace {

using SparseMatrix = Eigen::SparseMatrix<double>;

/// The band with the two rings of vertices around it that the equation looks at.
struct Band {
  TriangleMesh mesh;           // with numbers of its own
  std::vector<int> of_vertex;  // number in the band per vertex of the tooth, -1 outside
};

Band cut_out_band(const TriangleMesh& mesh, const std::vector<int>& free_vertices) {
  std::vector<bool> inside(mesh.vertices.size(), false);
  for (const int v : free_vertices) inside[static_cast<std::size_t>(v)] = true;
  std::vector<bool> taken(mesh.triangles.size(), false);
  for (int ring = 0; ring < 2; ++ring) {
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const Triangle& tri = mesh.triangles[t];
      taken[t] =
          taken[t] || std::any_of(tri.begin(), tri.end(), [&](int v) { return inside[static_cast<std::size_t>(v)]; });
    }
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      if (taken[t])
        for (const int v : mesh.triangles[t]) inside[static_cast<std::size_t>(v)] = true;
  }
  Band band;
  band.of_vertex.assign(mesh.vertices.size(), -1);
  // The second ring's own triangles are needed too: they make its Laplacian that of the whole mesh's one-ring.
  for (const Triangle& t : mesh.triangles) {
    if (std::none_of(t.begin(), t.end(), [&](int v) { return inside[static_cast<std::size_t>(v)]; })) continue;
    Triangle local = t;
    for (std::int32_t& v : local) {
      int& number = band.of_vertex[static_cast<std::size_t>(v)];
      if (number < 0) {
        number = static_cast<int>(band.mesh.vertices.size());
        band.mesh.vertices.push_back(mesh.vertices[static_cast<std::size_t>(v)]);
      }
      v = number;
    }
    band.mesh.triangles.push_back(local);
  }
  return band;
}

/// Cotangent Laplacian, negative semi-definite, and the lumped masses. Cotangents are bounded, so that one needle
/// triangle of the crown does not outweigh all others.
struct Operators {
  SparseMatrix laplacian;
  Eigen::VectorXd mass;
};

Operators build_operators(const TriangleMesh& mesh) {
  constexpr double largest_cotangent = 20;  // an angle of 2.9 degrees
  const auto n = static_cast<Eigen::Index>(mesh.vertices.size());
  Operators result{SparseMatrix(n, n), Eigen::VectorXd::Zero(n)};
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(12 * mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& tri = mesh.triangles[t];
    const auto angles = triangle_angles(mesh, t);
    const double area = triangle_area(mesh, t);
    for (std::size_t i = 0; i < 3; ++i) {
      const int a = tri[(i + 1) % 3];
      const int b = tri[(i + 2) % 3];
      const double cotangent = std::cos(angles[i]) / std::max(std::sin(angles[i]), 1e-12);
      const double w = 0.5 * std::clamp(cotangent, -largest_cotangent, largest_cotangent);
      entries.emplace_back(a, b, w);
      entries.emplace_back(b, a, w);
      entries.emplace_back(a, a, -w);
      entries.emplace_back(b, b, -w);
      result.mass[tri[i]] += area / 3;
    }
  }
  result.laplacian.setFromTriplets(entries.begin(), entries.end());
  const double floor = 1e-6 * result.mass.mean();
  result.mass = result.mass.cwiseMax(floor);
  return result;
}

/// Positions of the free vertices that solve the biharmonic equation with all others fixed; empty if the system cannot
/// be solved.
Eigen::MatrixXd solve_biharmonic(const TriangleMesh& mesh, const std::vector<int>& free_vertices) {
  const Band band = cut_out_band(mesh, free_vertices);
  const Operators operators = build_operators(band.mesh);
  const SparseMatrix bilaplacian =
      operators.laplacian * operators.mass.cwiseInverse().asDiagonal() * operators.laplacian;
  std::vector<int> row(band.mesh.vertices.size(), -1);
  std::vector<int> in_band;
  for (const int v : free_vertices) {
    in_band.push_back(band.of_vertex[static_cast<std::size_t>(v)]);
    row[static_cast<std::size_t>(in_band.back())] = static_cast<int>(in_band.size()) - 1;
  }
  const auto n = static_cast<Eigen::Index>(free_vertices.size());
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(n, 3);
  for (const int v : in_band) {
    const int r = row[static_cast<std::size_t>(v)];
    for (SparseMatrix::InnerIterator it(bilaplacian, v); it; ++it) {
      const int c = row[static_cast<std::size_t>(it.row())];
      if (c >= 0)
        entries.emplace_back(r, c, it.value());
      else
        right.row(r) -= it.value() * band.mesh.vertices[static_cast<std::size_t>(it.row())].transpose();
    }
  }
  SparseMatrix system(n, n);
  system.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<SparseMatrix> solver(system);
  if (solver.info() != Eigen::Success) return {};
  Eigen::MatrixXd solution = solver.solve(right);
  return solution.allFinite() ? solution : Eigen::MatrixXd{};
}

/// Displacements with the share of each that is applied.
class SafeMoves {
 public:
  SafeMoves(const JoinedTooth& tooth, const std::vector<int>& vertices, const Eigen::MatrixXd& target,
            const TransitionOptions& options)
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
  const TransitionOptions& options_;
  std::vector<double> share_;  // per vertex of the tooth
  std::vector<std::size_t> concerned_;
};

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
      result.vertices.empty() ? Eigen::MatrixXd{} : solve_biharmonic(tooth.mesh, result.vertices);
  if (target.rows() == 0) {
    result.applied = result.vertices.empty() ? 1 : 0;
    result.cuts_itself = !self_intersecting_triangles(tooth.mesh, crown_triangles).empty();
    return result;
  }
  SafeMoves moves(tooth, result.vertices, target, options);
  TriangleMesh smoothed = moves.moved();
  // Each pass takes some moves back, so this ends; where nothing can be lessened the cut was there before.
  for (int round = 1;; ++round) {
    while (moves.restrain_bad_triangles(smoothed)) smoothed = moves.moved();
    const auto cuts = self_intersecting_triangles(smoothed, crown_triangles);
    result.cuts_itself = !cuts.empty();
    if (cuts.empty() || round >= options.cut_rounds || !moves.restrain_cuts(smoothed, cuts)) break;
    smoothed = moves.moved();
  }
  for (const int v : result.vertices) {
    const auto i = static_cast<std::size_t>(v);
    result.largest_move = std::max(result.largest_move, (smoothed.vertices[i] - tooth.mesh.vertices[i]).norm());
  }
  result.applied = moves.mean_share();
  tooth.mesh = std::move(smoothed);
  return result;
}

}  // namespace rhizodont
