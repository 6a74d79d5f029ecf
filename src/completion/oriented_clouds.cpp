// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "completion/oriented_clouds.hpp"

#include <algorithm>

namespace rhizodont {

OrientedCloud cloud_of(const OrientedPoints& source, double scale) {
  OrientedCloud cloud;
  const auto count = static_cast<Eigen::Index>(source.points.size());
  cloud.points.resize(3, count);
  cloud.normals.resize(3, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    cloud.points.col(i) = scale * source.points[static_cast<std::size_t>(i)];
    cloud.normals.col(i) = source.normals[static_cast<std::size_t>(i)];
  }
  return cloud;
}

CloudFeatures features_of(const OrientedCloud& cloud, double normal_weight) {
  CloudFeatures features;
  for (std::size_t k = 0; k < 3; ++k) {
    for (Eigen::Index i = 0; i < cloud.size(); ++i) {
      features.rows[k].push_back(static_cast<float>(cloud.points(static_cast<Eigen::Index>(k), i)));
      features.rows[k + 3].push_back(
          static_cast<float>(normal_weight * cloud.normals(static_cast<Eigen::Index>(k), i)));
    }
  }
  return features;
}

NearestOfCloud nearest(const CloudFeatures& from, const CloudFeatures& to) {
  NearestOfCloud result;
  const std::size_t count = to.size();
  std::vector<float> squared(count);
  for (std::size_t i = 0; i < from.size(); ++i) {
    std::array<const float*, 6> row{};
    std::array<float, 6> at{};
    for (std::size_t k = 0; k < 6; ++k) row[k] = to.rows[k].data(), at[k] = from.rows[k][i];
    for (std::size_t j = 0; j < count; ++j) {
      float sum = 0;
      for (std::size_t k = 0; k < 6; ++k) sum += (row[k][j] - at[k]) * (row[k][j] - at[k]);
      squared[j] = sum;
    }
    const auto best = std::min_element(squared.begin(), squared.end());
    result.squared.push_back(static_cast<double>(*best));
    result.index.push_back(best - squared.begin());
  }
  return result;
}

}  // namespace rhizodont
