// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "poisson/neighbours.hpp"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <nanoflann.hpp>

namespace rhizodont {
namespace {

/// The cloud as nanoflann wants to see it.
struct Cloud {
  std::span<const Point> points;

  std::size_t kdtree_get_point_count() const { return points.size(); }
  double kdtree_get_pt(std::size_t i, std::size_t axis) const { return points[i][static_cast<Eigen::Index>(axis)]; }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Cloud>, Cloud, 3, std::uint32_t>;

}  // namespace

Neighbours nearest_neighbours(std::span<const Point> points, std::size_t count) {
  Neighbours result;
  result.count = std::min(count, points.size() - 1);
  result.indices.resize(points.size() * result.count);
  result.distances.resize(points.size() * result.count);
  const Cloud cloud{points};
  const Tree tree(3, cloud, nanoflann::KDTreeSingleIndexAdaptorParams(12));
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, points.size(), 64), [&](const auto& range) {
    std::vector<std::uint32_t> indices(result.count + 1);
    std::vector<double> squared(result.count + 1);
    std::vector<std::pair<double, int>> found(result.count + 1);
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      tree.knnSearch(points[i].data(), result.count + 1, indices.data(), squared.data());
      for (std::size_t k = 0; k < found.size(); ++k) found[k] = {squared[k], static_cast<int>(indices[k])};
      std::ranges::sort(found);
      std::size_t kept = 0;
      for (const auto& [squared_distance, index] : found) {
        if (index == static_cast<int>(i) || kept == result.count) continue;
        result.indices[i * result.count + kept] = index;
        result.distances[i * result.count + kept] = std::sqrt(squared_distance);
        ++kept;
      }
    }
  });
  return result;
}

}  // namespace rhizodont
