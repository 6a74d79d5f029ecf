// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <vector>

namespace rhizodont {

/// Oriented points as columns, millimetres.
struct OrientedCloud {
  Eigen::Matrix3Xd points, normals;

  Eigen::Index size() const { return points.cols(); }
};

/// Points times `scale`, with their normals.
OrientedCloud cloud_of(const OrientedPoints& source, double scale);

/// Six numbers per point, one list for each: coordinates, then weighted normals.
struct CloudFeatures {
  std::array<std::vector<float>, 6> rows;

  std::size_t size() const { return rows[0].size(); }
};

/// `normal_weight`: millimetres that a difference of 1 between unit normals counts for, >= 0.
CloudFeatures features_of(const OrientedCloud& cloud, double normal_weight);

/// Squared distance of each point of one cloud to the nearest of another, normals included, and which that is.
struct NearestOfCloud {
  std::vector<double> squared;
  std::vector<Eigen::Index> index;
};

/// By trying all pairs, which for some hundred points is faster than a tree. Precondition: `to` is not empty.
NearestOfCloud nearest(const CloudFeatures& from, const CloudFeatures& to);

}  // namespace rhizodont
