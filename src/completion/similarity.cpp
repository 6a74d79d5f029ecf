// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "completion/similarity.hpp"

#include <Eigen/Geometry>
#include <Eigen/SVD>

#include <algorithm>
#include <cassert>

namespace rhizodont {

Similarity similarity_of_pairs(const Eigen::Matrix3Xd& from, const Eigen::Matrix3Xd& to, const ScaleRange& range) {
  assert(from.cols() == to.cols() && from.cols() > 0);
  const Eigen::Vector3d mean_from = from.rowwise().mean(), mean_to = to.rowwise().mean();
  const Eigen::Matrix3Xd a = from.colwise() - mean_from, b = to.colwise() - mean_to;
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(b * a.transpose(), Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d sign(1, 1, (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1);
  Similarity result;
  result.rotation = svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
  const double spread = a.squaredNorm();
  result.scale = spread > 0 ? svd.singularValues().dot(sign) / spread : 1;
  result.scale = std::clamp(result.scale, range.low, range.high);
  result.shift = mean_to - result.scale * result.rotation * mean_from;
  return result;
}

}  // namespace rhizodont
