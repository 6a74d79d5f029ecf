// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// "Completing Dental Models While Preserving Crown Geometry and Meshing Topology", section 3.5: additional points are
//   sampled from the crown, so that the guiding surface runs close to it.
// M. Alexa et al., "Computing and rendering point set surfaces", 2003: moving points to a surface fitted to their
//   neighbours.

#include "guiding/guiding_cloud.hpp"

#include "base/option_range.hpp"
#include "mesh/geometry.hpp"
#include "mesh/nearest_vertex.hpp"
#include "mesh/sampling.hpp"
#include "poisson/neighbours.hpp"
#include "poisson/orientation.hpp"
#include "rhizodont/error.hpp"

#include <oneapi/tbb/parallel_for.h>
#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace rhizodont {
namespace {

/// Where predicted points are and should be, for those that lie on the crown.
struct CrownResiduals {
  std::vector<Point> places;
  std::vector<Eigen::Vector3d> moves;
};

struct SortedPrediction {
  OrientedPoints beyond;    // predicted points beyond the crown's border
  CrownResiduals on_crown;  // the others that are near enough to tell how far the prediction is off
  int dropped = 0;
};

SortedPrediction sort_prediction(const PreparedCrown& crown, const OrientedPoints& predicted, double gap) {
  std::vector<ClosestPoint> closest_points(predicted.points.size());
  tbb::parallel_for(std::size_t{0}, closest_points.size(),
                    [&](std::size_t i) { closest_points[i] = crown.surface.closest(predicted.points[i]); });
  SortedPrediction sorted;
  constexpr double believable = 1.5;  // mm; a predicted crown point farther off says nothing about its neighbours
  for (std::size_t i = 0; i < predicted.points.size(); ++i) {
    const Point& p = predicted.points[i];
    const ClosestPoint& closest = closest_points[i];
    if (lies_on_border(crown, closest)) {
      if (closest.distance > gap) {
        sorted.beyond.points.push_back(p);
        sorted.beyond.normals.push_back(predicted.normals[i]);
      } else {
        ++sorted.dropped;
      }
      continue;
    }
    ++sorted.dropped;
    const Eigen::Vector3d normal = triangle_normal(crown.mesh, static_cast<std::size_t>(closest.triangle));
    if (closest.distance > believable || normal.dot(predicted.normals[i]) < 0.3) continue;
    sorted.on_crown.places.push_back(p);
    sorted.on_crown.moves.push_back(closest.point - p);
  }
  return sorted;
}

/// Moves points by the mean error of the prediction on the crown nearby, fading over `reach`.
void correct(std::vector<Point>& points, const CrownResiduals& residuals, double reach) {
  if (residuals.places.size() < 8) return;
  const NearestVertexIndex index(residuals.places);
  for (Point& p : points) {
    const auto near = index.nearest(p, 24);
    const double nearest = std::sqrt(near.front().squared_distance);
    const double scale = near.back().squared_distance + 1e-12;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double weights = 0;
    for (const NearVertex& n : near) {
      const double w = std::exp(-n.squared_distance / scale);
      sum += w * residuals.moves[static_cast<std::size_t>(n.index)];
      weights += w;
    }
    p += std::exp(-(nearest / reach) * (nearest / reach)) / weights * sum;
  }
}

/// A point and normal on the quadric that fits the point and its neighbours on the same sheet, straight above or below
/// the point. A plane in its place would pull round roots in.
std::pair<Point, Eigen::Vector3d> on_local_quadric(const OrientedPoints& cloud, std::size_t centre,
                                                   std::span<const int> neighbours) {
  using Row = Eigen::Matrix<double, 6, 1>;
  const Point& origin = cloud.points[centre];
  const Eigen::Vector3d normal = cloud.normals[centre];
  const Eigen::Vector3d u = normal.unitOrthogonal();
  const Eigen::Vector3d v = normal.cross(u);
  double scale = 1e-12;
  for (const int n : neighbours) scale = std::max(scale, (cloud.points[static_cast<std::size_t>(n)] - origin).norm());
  Eigen::Matrix<double, 6, 6> matrix = Eigen::Matrix<double, 6, 6>::Zero();
  matrix(0, 0) = 1.0;  // the point itself
  Row right = Row::Zero();
  int used = 1;
  for (const int n : neighbours) {
    const auto i = static_cast<std::size_t>(n);
    const double agreement = normal.dot(cloud.normals[i]);
    if (agreement <= 0.2) continue;
    const Eigen::Vector3d d = (cloud.points[i] - origin) / scale;
    const double x = d.dot(u);
    const double y = d.dot(v);
    const Row row = (Row() << 1, x, y, x * x, x * y, y * y).finished();
    const double weight = agreement * std::exp(-2 * d.squaredNorm());
    matrix += weight * row * row.transpose();
    right += weight * d.dot(normal) * row;
    ++used;
  }
  if (used < 9) return {origin, normal};
  // Keeps the quadric from bending more than the points ask for where they are few.
  matrix.diagonal() += 1e-3 * matrix(0, 0) * (Row() << 0, 0.1, 0.1, 1, 1, 1).finished();
  const Row fit = matrix.ldlt().solve(right);
  if (!fit.allFinite() || std::abs(fit[0]) > 0.6) return {origin, normal};
  return {origin + scale * fit[0] * normal, (normal - fit[1] * u - fit[2] * v).normalized()};
}

/// Takes the noise out of predicted points. They move along their normals only: sliding would thin out the root's tip.
void smooth(OrientedPoints& cloud, int neighbours, int rounds) {
  if (rounds == 0) return;
  const Neighbours near = nearest_neighbours(cloud.points, static_cast<std::size_t>(neighbours) - 1);
  for (int round = 0; round < rounds; ++round) {
    OrientedPoints moved = cloud;
    tbb::parallel_for(std::size_t{0}, moved.points.size(), [&](std::size_t i) {
      std::tie(moved.points[i], moved.normals[i]) = on_local_quadric(cloud, i, near.of(i));
    });
    cloud = std::move(moved);
  }
}

void require_in_range(const GuidingCloudOptions& options) {
  require_ranges("the guiding cloud",
                 {{"crown_spacing", options.crown_spacing, OptionRange::above(0)},
                  {"orientation_spacing", options.orientation_spacing, OptionRange::above(0)},
                  {"crown_confidence", options.crown_confidence, OptionRange::above(0)},
                  {"gap", options.gap, OptionRange::at_least(0)},
                  {"correction_reach", options.correction_reach, OptionRange::above(0)},
                  {"smoothing_neighbours", options.smoothing_neighbours, OptionRange::at_least(12)},
                  {"smoothing_rounds", options.smoothing_rounds, OptionRange::at_least(0)}});
}

}  // namespace

GuidingCloud assemble_guiding_cloud(const PreparedCrown& crown, const OrientedPoints& predicted,
                                    const GuidingCloudOptions& options) {
  require_in_range(options);
  SortedPrediction sorted = sort_prediction(crown, predicted, options.gap);
  if (sorted.beyond.points.size() < 32)
    throw NoResultError("The network predicts no root beyond this crown. Is enough of it there, and is it erupted?");
  correct(sorted.beyond.points, sorted.on_crown, options.correction_reach);

  GuidingCloud cloud;
  cloud.predicted_dropped = sorted.dropped;
  for (const Eigen::Vector3d& move : sorted.on_crown.moves)
    cloud.prediction_error += move.norm() / static_cast<double>(sorted.on_crown.moves.size());
  const auto count = static_cast<std::size_t>(
      std::max(500.0, surface_area(crown.mesh) / (options.crown_spacing * options.crown_spacing)));
  const SurfaceSamples on_crown = sample_surface(crown.mesh, count, 1);

  // Orientation looks at root and crown together, so that the root's normals follow on from the crown's. Samples are
  // independent of each other: the first ones cover the crown as evenly as all, and are as dense as the prediction.
  const auto context = static_cast<std::ptrdiff_t>(std::min(
      static_cast<double>(count),
      std::max(200.0, surface_area(crown.mesh) / (options.orientation_spacing * options.orientation_spacing))));
  std::vector<Point> points(on_crown.points.begin(), on_crown.points.begin() + context);
  std::vector<Eigen::Vector3d> hints(on_crown.normals.begin(), on_crown.normals.begin() + context);
  points.insert(points.end(), sorted.beyond.points.begin(), sorted.beyond.points.end());
  hints.insert(hints.end(), sorted.beyond.normals.begin(), sorted.beyond.normals.end());
  const OrientedPoints oriented = orient_normals(points, hints);
  OrientedPoints root;
  root.points.assign(oriented.points.begin() + context, oriented.points.end());
  root.normals.assign(oriented.normals.begin() + context, oriented.normals.end());
  smooth(root, options.smoothing_neighbours, options.smoothing_rounds);

  cloud.samples = {on_crown.points, on_crown.normals};
  cloud.samples.points.insert(cloud.samples.points.end(), root.points.begin(), root.points.end());
  cloud.samples.normals.insert(cloud.samples.normals.end(), root.normals.begin(), root.normals.end());
  cloud.confidence.assign(on_crown.points.size(), options.crown_confidence);
  cloud.confidence.resize(cloud.samples.points.size(), 1.0);
  cloud.crown_samples = static_cast<int>(count);
  return cloud;
}

}  // namespace rhizodont
