// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// "Completing Dental Models While Preserving Crown Geometry and Meshing Topology", section 3.6: transition
// optimisation. M. Botsch and L. Kobbelt, "An intuitive framework for real-time freeform modeling", 2004: boundary
// conditions of
//   higher order by fixing vertices on both sides of the band.

#include "fusion/transition.hpp"

#include "mesh/geometry.hpp"
#include "mesh/self_intersection.hpp"

#include <Eigen/SparseCholesky>

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

namespace rhizodont {
namespace {

using SparseMatrix = Eigen::SparseMatrix<double>;

/// Distance along edges from the crown, up to `limit`; infinity beyond.
std::vector<double> distance_from_crown(const RestoredTooth& tooth, double limit) {
  const std::size_t n = tooth.mesh.vertices.size();
  std::vector<std::vector<int>> around(n);
  for (const Triangle& t : tooth.mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i) around[static_cast<std::size_t>(t[i])].push_back(t[(i + 1) % 3]);
  std::vector<double> distance(n, std::numeric_limits<double>::infinity());
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  for (int v = 0; v < tooth.crown_vertices; ++v) {
    distance[static_cast<std::size_t>(v)] = 0;
    queue.push({0, v});
  }
  while (!queue.empty()) {
    const auto [d, v] = queue.top();
    queue.pop();
    if (d > distance[static_cast<std::size_t>(v)]) continue;
    for (const int w : around[static_cast<std::size_t>(v)]) {
      const double there =
          d +
          (tooth.mesh.vertices[static_cast<std::size_t>(v)] - tooth.mesh.vertices[static_cast<std::size_t>(w)]).norm();
      if (there >= distance[static_cast<std::size_t>(w)] || there > limit) continue;
      distance[static_cast<std::size_t>(w)] = there;
      queue.push({there, w});
    }
  }
  return distance;
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
  const Operators operators = build_operators(mesh);
  const SparseMatrix bilaplacian =
      operators.laplacian * operators.mass.cwiseInverse().asDiagonal() * operators.laplacian;
  std::vector<int> row(mesh.vertices.size(), -1);
  for (std::size_t i = 0; i < free_vertices.size(); ++i)
    row[static_cast<std::size_t>(free_vertices[i])] = static_cast<int>(i);
  const auto n = static_cast<Eigen::Index>(free_vertices.size());
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(n, 3);
  for (const int v : free_vertices) {
    const int r = row[static_cast<std::size_t>(v)];
    for (SparseMatrix::InnerIterator it(bilaplacian, v); it; ++it) {
      const int c = row[static_cast<std::size_t>(it.row())];
      if (c >= 0)
        entries.emplace_back(r, c, it.value());
      else
        right.row(r) -= it.value() * mesh.vertices[static_cast<std::size_t>(it.row())].transpose();
    }
  }
  SparseMatrix system(n, n);
  system.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<SparseMatrix> solver(system);
  if (solver.info() != Eigen::Success) return {};
  Eigen::MatrixXd solution = solver.solve(right);
  return solution.allFinite() ? solution : Eigen::MatrixXd{};
}

bool is_safe(const TriangleMesh& before, const TriangleMesh& after, const std::vector<bool>& moved) {
  for (std::size_t t = 0; t < after.triangles.size(); ++t) {
    const Triangle& tri = after.triangles[t];
    if (std::none_of(tri.begin(), tri.end(), [&](int v) { return moved[static_cast<std::size_t>(v)]; })) continue;
    if (triangle_normal(before, t).dot(triangle_normal(after, t)) <= 0) return false;
  }
  return self_intersecting_triangles(after).empty();
}

}  // namespace

Transition smooth_transition(RestoredTooth& tooth, const TransitionOptions& options) {
  Transition result;
  const auto distance = distance_from_crown(tooth, options.band);
  std::vector<bool> moved(tooth.mesh.vertices.size(), false);
  for (std::size_t v = static_cast<std::size_t>(tooth.crown_vertices); v < distance.size(); ++v) {
    if (!std::isfinite(distance[v])) continue;
    result.vertices.push_back(static_cast<int>(v));
    moved[v] = true;
  }
  if (result.vertices.empty()) return result;
  const Eigen::MatrixXd target = solve_biharmonic(tooth.mesh, result.vertices);
  if (target.rows() == 0) return result;
  for (double share = 1; share > 0.1; share /= 2) {
    TriangleMesh smoothed = tooth.mesh;
    double largest = 0;
    for (std::size_t i = 0; i < result.vertices.size(); ++i) {
      Point& p = smoothed.vertices[static_cast<std::size_t>(result.vertices[i])];
      const Eigen::Vector3d move = share * (target.row(static_cast<Eigen::Index>(i)).transpose() - p);
      p += move;
      largest = std::max(largest, move.norm());
    }
    if (!is_safe(tooth.mesh, smoothed, moved)) continue;
    tooth.mesh = std::move(smoothed);
    result.applied = share;
    result.largest_move = largest;
    break;
  }
  return result;
}

}  // namespace rhizodont
