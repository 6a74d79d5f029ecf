// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/sampling.hpp"

#include "mesh/geometry.hpp"
#include "mesh/mesh_checks.hpp"
#include "rhizodont/error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

namespace rhizodont {
namespace {

// The standard fixes the engine's numbers but not those of its distributions: this is the same everywhere.
double uniform(std::mt19937_64& engine) { return static_cast<double>(engine() >> 11) * 0x1p-53; }

std::vector<double> cumulative_areas(const TriangleMesh& mesh) {
  std::vector<double> sums(mesh.triangles.size());
  double sum = 0;
  for (std::size_t t = 0; t < sums.size(); ++t) sums[t] = sum += triangle_area(mesh, t);
  return sums;
}

std::vector<int> lexicographic_order(const std::vector<Point>& points) {
  std::vector<int> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int i, int j) {
    const Point &a = points[static_cast<std::size_t>(i)], &b = points[static_cast<std::size_t>(j)];
    const bool less = std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
    return less || (a == b && i < j);
  });
  return order;
}

}  // namespace

SurfaceSamples sample_surface(const TriangleMesh& mesh, std::size_t count, std::uint64_t seed) {
  require_valid_indices(mesh);
  const std::vector<double> sums = cumulative_areas(mesh);
  if (sums.empty() || !(sums.back() > 0) || !std::isfinite(sums.back()))
    throw InputError("the mesh has no surface area to take points from");
  std::mt19937_64 engine(seed);
  SurfaceSamples samples;
  for (std::size_t k = 0; k < count; ++k) {
    // upper_bound: never a triangle without area
    auto place = std::upper_bound(sums.begin(), sums.end(), uniform(engine) * sums.back());
    if (place == sums.end()) place = std::lower_bound(sums.begin(), sums.end(), sums.back());
    const auto t = static_cast<std::size_t>(place - sums.begin());
    const double root = std::sqrt(uniform(engine)), v = uniform(engine);
    const Triangle& triangle = mesh.triangles[t];
    samples.points.push_back((1 - root) * mesh.vertices[static_cast<std::size_t>(triangle[0])] +
                             root * (1 - v) * mesh.vertices[static_cast<std::size_t>(triangle[1])] +
                             root * v * mesh.vertices[static_cast<std::size_t>(triangle[2])]);
    samples.normals.push_back(triangle_normal(mesh, t));
    samples.triangles.push_back(static_cast<int>(t));
  }
  return samples;
}

std::vector<int> farthest_point_sampling(const std::vector<Point>& points, std::size_t count) {
  if (count > points.size()) throw UsageError("more points are asked for than there are");
  require_finite(points);
  if (count == 0) return {};
  // Everything runs in lexicographic order: the centroid's rounding and all ties are then independent of the order
  // given.
  const std::vector<int> order = lexicographic_order(points);
  Eigen::Matrix3Xd sorted(3, static_cast<Eigen::Index>(points.size()));
  for (std::size_t i = 0; i < order.size(); ++i)
    sorted.col(static_cast<Eigen::Index>(i)) = points[static_cast<std::size_t>(order[i])];

  Eigen::Vector3d last = Eigen::Vector3d::Zero();
  for (Eigen::Index i = 0; i < sorted.cols(); ++i) last += sorted.col(i);
  last /= static_cast<double>(sorted.cols());

  Eigen::RowVectorXd distance = (sorted.colwise() - last).colwise().squaredNorm();
  std::vector<int> chosen;
  for (bool first = true; chosen.size() < count; first = false) {
    if (!first) distance = distance.cwiseMin((sorted.colwise() - last).colwise().squaredNorm());
    Eigen::Index farthest = 0;
    distance.maxCoeff(&farthest);
    if (first) distance.setConstant(std::numeric_limits<double>::infinity());
    distance[farthest] = -1;  // chosen: never again, even where all others coincide with chosen ones
    last = sorted.col(farthest);
    chosen.push_back(order[static_cast<std::size_t>(farthest)]);
  }
  return chosen;
}

}  // namespace rhizodont
