// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Tangent planes from principal axes (Hoppe, DeRose, Duchamp, McDonald and Stuetzle 1992), reweighted by the distance
// from the plane so that the sheet on the other side of a thin part drops out.
#include "poisson/tangent_planes.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace rhizodont {
namespace {

/// How much a neighbour's hint speaks for its lying on the same sheet.
double hint_agreement(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  if (a.isZero(0.0) || b.isZero(0.0)) return 1.0;
  return std::max(0.02, a.dot(b));
}

TangentPlane plane_from(const Eigen::Matrix3d& covariance) {
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes;
  axes.computeDirect(covariance);
  const Eigen::Vector3d spread = axes.eigenvalues().cwiseMax(0.0);
  TangentPlane plane;
  plane.normal = axes.eigenvectors().col(0);
  if (!plane.normal.allFinite() || plane.normal.squaredNorm() < 0.5) plane.normal = Eigen::Vector3d::UnitZ();
  plane.normal.normalize();
  const double total = spread.sum();
  if (!(total > 0.0)) return {plane.normal, 0.0};
  const double flat = std::clamp(1.0 - (spread[0] / total - 0.03) / 0.12, 0.0, 1.0);
  const double broad = std::clamp(4.0 * (spread[1] - spread[0]) / total, 0.0, 1.0);
  plane.reliability = flat * broad;
  return plane;
}

}  // namespace

double neighbour_scale(const Neighbours& near, std::size_t i) {
  const auto distances = near.distances_of(i);
  return distances[std::min<std::size_t>(5, distances.size() - 1)];
}

std::vector<TangentPlane> tangent_planes(std::span<const Point> points, std::span<const Eigen::Vector3d> hints,
                                         const Neighbours& near) {
  constexpr int rounds = 3;
  constexpr double off_plane = 0.35;  // of the neighbour scale: how far off the plane a neighbour may lie to count
  std::vector<TangentPlane> planes(points.size());
  tbb::parallel_for(std::size_t{0}, points.size(), [&](std::size_t i) {
    const auto indices = near.of(i);
    const auto distances = near.distances_of(i);
    const double scale = neighbour_scale(near, i);
    if (!(scale > 0.0)) {
      planes[i] = {Eigen::Vector3d::UnitZ(), 0.0};
      return;
    }
    for (int round = 0; round < rounds; ++round) {
      Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
      Eigen::Vector3d mean = Eigen::Vector3d::Zero();
      double total = 1.0;  // the point itself, at the origin
      for (std::size_t k = 0; k < indices.size(); ++k) {
        const auto j = static_cast<std::size_t>(indices[k]);
        const Eigen::Vector3d to = points[j] - points[i];
        double weight = std::exp(-0.5 * std::pow(distances[k] / scale, 2)) * hint_agreement(hints[i], hints[j]);
        if (round > 0) weight *= std::exp(-std::pow(to.dot(planes[i].normal) / (off_plane * scale), 2));
        covariance += weight * to * to.transpose();
        mean += weight * to;
        total += weight;
      }
      covariance -= mean * mean.transpose() / total;
      planes[i] = plane_from(covariance);
    }
  });
  return planes;
}

}  // namespace rhizodont
