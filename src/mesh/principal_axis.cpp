// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// I. T. Jolliffe, "Principal Component Analysis", 2nd edition, 2002.
#include "mesh/principal_axis.hpp"

#include <Eigen/Eigenvalues>

namespace rhizodont {

Eigen::Vector3d principal_axis(const std::vector<Point>& points) {
  Point mean = Point::Zero();
  for (const Point& p : points) mean += p;
  mean /= static_cast<double>(points.size());
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const Point& p : points) covariance += (p - mean) * (p - mean).transpose();
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance).eigenvectors().col(2);
}

}  // namespace rhizodont
