// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

namespace rhizodont {

/// to = scale * rotation * from + shift.
struct Similarity {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();  ///< proper
  double scale = 1;
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();
};

struct ScaleRange {
  double low, high;
};

/// The similarity that takes each column of `from` nearest to that of `to`, in the sense of least squares; a scale out
/// of `range` is set to its end. Precondition: as many columns in both, at least one. S. Umeyama, "Least-squares
/// estimation of transformation parameters between two point patterns", 1991.
Similarity similarity_of_pairs(const Eigen::Matrix3Xd& from, const Eigen::Matrix3Xd& to, const ScaleRange& range);

}  // namespace rhizodont
