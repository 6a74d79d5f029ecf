// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Orientation of normals over a neighbour graph. Hoppe et al. (1992) walk a spanning tree; here the signs come from one
// linear solve with all edges (a signed graph Laplacian), in which hints are weak springs, so that wrong hints and
// wrong edges are outvoted by their neighbours. Normals are compared after reflection in the plane midway between two
// points, as on a circle through both: this also relates the two sides of a thin part, or of a gap, the right way.
#include "poisson/orientation.hpp"

#include <fmt/format.h>

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/option_range.hpp"
#include "poisson/neighbours.hpp"
#include "poisson/tangent_planes.hpp"
#include "rhizodont/error.hpp"

namespace rhizodont {
namespace {

struct Edge {
  int a, b;
  double weight;  // > 0
  double sign;    // 1 if the planes' normals point to the same side, -1 if not
};

void require_in_range(const OrientationOptions& options) {
  require_ranges("orienting normals", {{"neighbours", options.neighbours, OptionRange::at_least(4).at_most(100)},
                                       {"hint_trust", options.hint_trust, share_range},
                                       {"blend", options.blend, share_range}});
}

std::vector<Eigen::Vector3d> checked_hints(std::span<const Point> points, std::span<const Eigen::Vector3d> hints,
                                           const OrientationOptions& options) {
  require_in_range(options);
  if (points.size() < 4) throw InputError("Fewer than 4 points do not tell a surface.");
  if (!hints.empty() && hints.size() != points.size())
    throw InputError(fmt::format("There are {} points but {} hints.", points.size(), hints.size()));
  std::vector<std::int64_t> bad_points, bad_hints;
  std::vector<Eigen::Vector3d> unit(points.size(), Eigen::Vector3d::Zero());
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!points[i].allFinite()) bad_points.push_back(static_cast<std::int64_t>(i));
    if (hints.empty()) continue;
    if (!hints[i].allFinite()) bad_hints.push_back(static_cast<std::int64_t>(i));
    unit[i] = hints[i].stableNormalized();
    if (hints[i].isZero(0.0)) unit[i].setZero();
  }
  if (!bad_points.empty()) throw InputError("Some points have coordinates that are not numbers.", bad_points);
  if (!bad_hints.empty()) throw InputError("Some hints for normals are not numbers.", bad_hints);
  return unit;
}

std::vector<Edge> neighbour_edges(std::span<const Point> points, const std::vector<TangentPlane>& planes,
                                  const Neighbours& near) {
  std::vector<Edge> edges;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto indices = near.of(i);
    const auto distances = near.distances_of(i);
    for (std::size_t k = 0; k < indices.size(); ++k) {
      const auto j = static_cast<std::size_t>(indices[k]);
      const bool mutual = std::ranges::count(near.of(j), static_cast<int>(i)) > 0;
      if (mutual && j < i) continue;  // seen from the other side
      const double scale = std::max(neighbour_scale(near, i), neighbour_scale(near, j));
      double agreement = planes[i].normal.dot(planes[j].normal);
      if (distances[k] > 0.0) {
        const Eigen::Vector3d along = (points[j] - points[i]) / distances[k];
        agreement -= 2.0 * planes[i].normal.dot(along) * planes[j].normal.dot(along);
      }
      const double closeness = scale > 0.0 ? std::exp(-0.5 * std::pow(distances[k] / scale, 2)) : 1.0;
      // A floor keeps the graph connected where planes are at odds.
      const double weight = closeness * std::pow(agreement, 4) + 1e-6;
      edges.push_back({static_cast<int>(i), static_cast<int>(j), weight, agreement < 0.0 ? -1.0 : 1.0});
    }
  }
  return edges;
}

/// Connected parts of the graph, numbered by first point.
std::vector<int> parts_of(std::size_t count, const std::vector<Edge>& edges) {
  std::vector<int> parent(count);
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int i) {
    while (parent[static_cast<std::size_t>(i)] != i) {
      int& up = parent[static_cast<std::size_t>(i)];
      up = parent[static_cast<std::size_t>(up)];
      i = up;
    }
    return i;
  };
  for (const Edge& edge : edges) {
    const int a = root(edge.a), b = root(edge.b);
    parent[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
  }
  std::vector<int> number(count, -1), part(count);
  int next = 0;
  for (std::size_t i = 0; i < count; ++i) {
    int& n = number[static_cast<std::size_t>(root(static_cast<int>(i)))];
    if (n < 0) n = next++;
    part[i] = n;
  }
  return part;
}

/// Signs of the planes' normals: those that minimise the disagreement along edges and with the hints.
class SignSolve {
 public:
  SignSolve(std::span<const Point> points, const std::vector<TangentPlane>& planes,
            const std::vector<Eigen::Vector3d>& hints, const std::vector<Edge>& edges, double hint_trust)
      : edges_(edges), strength_(points.size(), 0.0), target_(points.size(), 0.0) {
    std::vector<double> weight(points.size(), 0.0);
    for (const Edge& edge : edges) {
      weight[static_cast<std::size_t>(edge.a)] += edge.weight;
      weight[static_cast<std::size_t>(edge.b)] += edge.weight;
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double agreement = hints[i].dot(planes[i].normal);
      strength_[i] = hint_trust * weight[i] * std::abs(agreement);
      target_[i] = agreement < 0.0 ? -1.0 : 1.0;
    }
    anchor_parts_without_hints(points, planes, weight);
  }

  std::vector<double> solve() const {
    const auto count = static_cast<Eigen::Index>(strength_.size());
    std::vector<Eigen::Triplet<double>> entries;
    Eigen::VectorXd right(count);
    for (Eigen::Index i = 0; i < count; ++i) {
      const auto s = static_cast<std::size_t>(i);
      entries.emplace_back(static_cast<int>(i), static_cast<int>(i), strength_[s] + 1e-9);
      right[i] = strength_[s] * target_[s];
    }
    for (const Edge& edge : edges_) {
      entries.emplace_back(edge.a, edge.a, edge.weight);
      entries.emplace_back(edge.b, edge.b, edge.weight);
      entries.emplace_back(std::max(edge.a, edge.b), std::min(edge.a, edge.b), -edge.sign * edge.weight);
    }
    Eigen::SparseMatrix<double> matrix(count, count);
    matrix.setFromTriplets(entries.begin(), entries.end());
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower> factor(matrix);
    const Eigen::VectorXd solution = factor.solve(right);
    return settle(std::vector<double>(solution.begin(), solution.end()));
  }

 private:
  /// In a part without hints the farthest point in some direction is one whose outward side is known.
  void anchor_parts_without_hints(std::span<const Point> points, const std::vector<TangentPlane>& planes,
                                  const std::vector<double>& weight) {
    const std::vector<int> part = parts_of(points.size(), edges_);
    const auto parts = static_cast<std::size_t>(std::ranges::max(part)) + 1;
    std::vector<double> hinted(parts, 0.0);
    for (std::size_t i = 0; i < points.size(); ++i) hinted[static_cast<std::size_t>(part[i])] += strength_[i];
    for (std::size_t p = 0; p < parts; ++p) {
      if (hinted[p] > 0.0) continue;
      double best = -1.0;
      std::size_t anchor = 0;
      Eigen::Vector3d outward = Eigen::Vector3d::UnitX();
      for (int axis = 0; axis < 3; ++axis)
        for (const double side : {-1.0, 1.0}) {
          const Eigen::Vector3d direction = side * Eigen::Vector3d::Unit(axis);
          std::size_t farthest = points.size();
          for (std::size_t i = 0; i < points.size(); ++i)
            if (part[i] == static_cast<int>(p) &&
                (farthest == points.size() || points[i].dot(direction) > points[farthest].dot(direction)))
              farthest = i;
          const double facing = std::abs(planes[farthest].normal.dot(direction));
          if (facing > best) {
            best = facing;
            anchor = farthest;
            outward = direction;
          }
        }
      strength_[anchor] = weight[anchor] + 1.0;
      target_[anchor] = planes[anchor].normal.dot(outward) < 0.0 ? -1.0 : 1.0;
    }
  }

  /// Signs, each made to agree with the weighted majority of its neighbours and its hint, until nothing changes.
  std::vector<double> settle(std::vector<double> sign) const {
    for (double& s : sign) s = s < 0.0 ? -1.0 : 1.0;
    for (int sweep = 0; sweep < 10; ++sweep) {
      std::vector<double> pull(sign.size());
      for (std::size_t i = 0; i < sign.size(); ++i) pull[i] = strength_[i] * target_[i];
      for (const Edge& edge : edges_) {
        const auto a = static_cast<std::size_t>(edge.a), b = static_cast<std::size_t>(edge.b);
        pull[a] += edge.weight * edge.sign * sign[b];
        pull[b] += edge.weight * edge.sign * sign[a];
      }
      bool changed = false;
      for (std::size_t i = 0; i < sign.size(); ++i)
        if (pull[i] * sign[i] < 0.0) {
          sign[i] = -sign[i];
          changed = true;
        }
      if (!changed) break;
    }
    return sign;
  }

  const std::vector<Edge>& edges_;
  std::vector<double> strength_, target_;
};

/// Turns each part whose normals point inward, as told by their flux from the part's centre. A part with hints is
/// turned only if the flux is clear, since an open part has little of it.
void turn_outward(OrientedPoints& oriented, const std::vector<Eigen::Vector3d>& hints, const std::vector<Edge>& edges,
                  const Neighbours& near) {
  constexpr double clear = 0.2;  // of the flux of a sphere
  const std::vector<int> part = parts_of(oriented.points.size(), edges);
  const auto parts = static_cast<std::size_t>(std::ranges::max(part)) + 1;
  std::vector<Eigen::Vector3d> centre(parts, Eigen::Vector3d::Zero());
  std::vector<double> total(parts, 0.0), flux(parts, 0.0), most(parts, 0.0);
  std::vector<char> hinted(parts, 0);
  std::vector<double> area(part.size());
  for (std::size_t i = 0; i < part.size(); ++i) {
    const auto p = static_cast<std::size_t>(part[i]);
    area[i] = std::pow(neighbour_scale(near, i), 2);
    centre[p] += area[i] * oriented.points[i];
    total[p] += area[i];
    if (!hints[i].isZero(0.0)) hinted[p] = 1;
  }
  for (std::size_t i = 0; i < part.size(); ++i) {
    const auto p = static_cast<std::size_t>(part[i]);
    if (!(total[p] > 0.0)) continue;
    const Eigen::Vector3d arm = oriented.points[i] - centre[p] / total[p];
    flux[p] += area[i] * arm.dot(oriented.normals[i]);
    most[p] += area[i] * arm.norm();
  }
  for (std::size_t i = 0; i < part.size(); ++i) {
    const auto p = static_cast<std::size_t>(part[i]);
    if (flux[p] < (hinted[p] ? -clear * most[p] : 0.0)) oriented.normals[i] = -oriented.normals[i];
  }
}

}  // namespace

OrientedPoints orient_normals(std::span<const Point> points, std::span<const Eigen::Vector3d> hints,
                              const OrientationOptions& options) {
  const std::vector<Eigen::Vector3d> unit_hints = checked_hints(points, hints, options);
  const Neighbours near = nearest_neighbours(points, static_cast<std::size_t>(options.neighbours));
  const std::vector<TangentPlane> planes = tangent_planes(points, unit_hints, near);
  const std::vector<Edge> edges = neighbour_edges(points, planes, near);
  const std::vector<double> signs = SignSolve(points, planes, unit_hints, edges, options.hint_trust).solve();

  OrientedPoints oriented;
  oriented.points.assign(points.begin(), points.end());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d normal = signs[i] * planes[i].normal;
    const Eigen::Vector3d blended = normal + options.blend * (1.0 - planes[i].reliability) * unit_hints[i];
    // Opposite and equally strong: the plane's side was settled by the neighbours, keep it.
    oriented.normals.push_back(blended.norm() > 1e-3 ? blended.normalized() : normal);
  }
  if (options.check_outward) turn_outward(oriented, unit_hints, edges, near);
  return oriented;
}

}  // namespace rhizodont
