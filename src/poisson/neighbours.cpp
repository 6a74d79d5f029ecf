// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "poisson/neighbours.hpp"
#include "mesh/mesh_checks.hpp"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cassert>
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

/// Searches in one tree, with the room that they need.
class Search {
 public:
  explicit Search(const Tree& tree) : tree_(tree) {}

  /// The `count` points nearest to point i, itself left out, and their distances.
  void run(const Point& p, std::size_t i, std::size_t count, int* neighbours, double* distances) {
    indices_.resize(count + 1);
    squared_.resize(count + 1);
    found_.resize(count + 1);
    tree_.knnSearch(p.data(), count + 1, indices_.data(), squared_.data());
    for (std::size_t k = 0; k <= count; ++k) found_[k] = {squared_[k], static_cast<int>(indices_[k])};
    std::ranges::sort(found_);
    std::size_t kept = 0;
    for (const auto& [squared_distance, index] : found_) {
      if (index == static_cast<int>(i) || kept == count) continue;
      neighbours[kept] = index;
      distances[kept] = std::sqrt(squared_distance);
      ++kept;
    }
  }

 private:
  const Tree& tree_;
  std::vector<std::uint32_t> indices_;
  std::vector<double> squared_;
  std::vector<std::pair<double, int>> found_;
};

template <class Body>
void for_each_point(std::size_t count, const Tree& tree, const Body& body) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 64), [&](const auto& range) {
    Search search(tree);
    for (std::size_t i = range.begin(); i < range.end(); ++i) body(search, i);
  });
}

}  // namespace

Neighbours nearest_neighbours(std::span<const Point> points, std::size_t count) {
  assert(points.size() >= 2 && is_finite(points));
  Neighbours result;
  result.count = std::min(count, points.size() - 1);
  result.indices.resize(points.size() * result.count);
  result.distances.resize(points.size() * result.count);
  const Cloud cloud{points};
  const Tree tree(3, cloud, nanoflann::KDTreeSingleIndexAdaptorParams(12));
  for_each_point(points.size(), tree, [&](Search& search, std::size_t i) {
    search.run(points[i], i, result.count, result.indices.data() + i * result.count,
               result.distances.data() + i * result.count);
  });
  return result;
}

void visit_neighbours(std::span<const Point> points, std::size_t few, std::size_t many,
                      const std::function<bool(std::size_t, std::span<const int>, std::span<const double>)>& visit) {
  assert(points.size() >= 2 && is_finite(points));
  few = std::min(few, points.size() - 1);
  many = std::min(many, points.size() - 1);
  const Cloud cloud{points};
  const Tree tree(3, cloud, nanoflann::KDTreeSingleIndexAdaptorParams(12));
  for_each_point(points.size(), tree, [&](Search& search, std::size_t i) {
    std::vector<int> neighbours(many);
    std::vector<double> distances(many);
    for (const std::size_t count : {few, many}) {
      search.run(points[i], i, count, neighbours.data(), distances.data());
      if (visit(i, std::span(neighbours).first(count), std::span(distances).first(count))) break;
    }
  });
}

}  // namespace rhizodont
