// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/nearest_vertex.hpp"

#include "mesh/mesh_checks.hpp"
#include "rhizodont/error.hpp"

#include <nanoflann.hpp>

#include <algorithm>
#include <array>
#include <limits>

namespace rhizodont {
namespace {

bool nearer(const NearVertex& a, const NearVertex& b) {
  return a.squared_distance != b.squared_distance ? a.squared_distance < b.squared_distance : a.index < b.index;
}

// The tree adds up box distances with rounding errors of its own, and passes over what is as far as the bound.
double beyond(double squared_distance) { return squared_distance * (1 + 1e-12) + std::numeric_limits<double>::min(); }

// Keeps the k nearest in order. (nanoflann's own set keeps whichever of equally near points the tree meets first.)
class NearestSet {
 public:
  using DistanceType = double;
  using IndexType = std::uint32_t;
  explicit NearestSet(std::span<NearVertex> found) : found_(found) {}
  std::size_t size() const { return size_; }
  bool full() const { return size_ == found_.size(); }
  bool addPoint(double squared_distance, std::uint32_t index) {
    const NearVertex fresh{static_cast<int>(index), squared_distance};
    if (full() && !nearer(fresh, found_[size_ - 1])) return true;
    std::size_t at = full() ? size_ - 1 : size_++;
    for (; at > 0 && nearer(fresh, found_[at - 1]); --at) found_[at] = found_[at - 1];
    found_[at] = fresh;
    return true;
  }
  double worstDist() const {
    return full() ? beyond(found_[size_ - 1].squared_distance) : std::numeric_limits<double>::max();
  }

 private:
  std::span<NearVertex> found_;
  std::size_t size_ = 0;
};

// Gathers everything within a squared radius, the bound included (nanoflann's own radius set excludes it).
class ClosedBall {
 public:
  using DistanceType = double;
  using IndexType = std::uint32_t;
  ClosedBall(double squared_radius, std::vector<NearVertex>& found) : bound_(squared_radius), found_(found) {}
  std::size_t size() const { return found_.size(); }
  bool full() const { return true; }
  bool addPoint(double squared_distance, std::uint32_t index) {
    if (squared_distance <= bound_) found_.push_back({static_cast<int>(index), squared_distance});
    return true;
  }
  double worstDist() const { return beyond(bound_); }

 private:
  double bound_;
  std::vector<NearVertex>& found_;
};

}  // namespace

struct NearestVertexIndex::Tree {
  std::vector<Point> points;
  using Index = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Tree>, Tree, 3, std::uint32_t>;
  std::unique_ptr<Index> index;

  std::size_t kdtree_get_point_count() const { return points.size(); }
  double kdtree_get_pt(std::size_t i, std::size_t axis) const { return points[i][static_cast<Eigen::Index>(axis)]; }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }

  std::vector<NearVertex> ball(const Point& query, double squared_radius) const {
    std::vector<NearVertex> found;
    ClosedBall gather(squared_radius, found);
    index->findNeighbors(gather, query.data(), nanoflann::SearchParams(0, 0.0F, false));
    std::sort(found.begin(), found.end(), nearer);
    return found;
  }

  /// The nearest from balls that grow until one holds enough; `found` is much shorter than the list of all points.
  std::size_t nearest_of_balls(const Point& query, std::span<NearVertex> found) const {
    std::array<NearVertex, 32> first;
    NearestSet set(first);
    index->findNeighbors(set, query.data(), nanoflann::SearchParams(0, 0.0F, false));
    // On a surface the number of points grows with the squared radius.
    double squared_radius =
        first.back().squared_distance * static_cast<double>(found.size()) / static_cast<double>(first.size());
    if (!(squared_radius > 0)) return nearest_of_all(query, found);
    for (;; squared_radius *= 2) {
      const std::vector<NearVertex> near = ball(query, squared_radius);
      if (near.size() < found.size()) continue;
      std::copy_n(near.begin(), found.size(), found.begin());
      return found.size();
    }
  }

  std::size_t nearest_of_all(const Point& query, std::span<NearVertex> found) const {
    std::vector<NearVertex> all(points.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
      const Eigen::Vector3d d = query - points[i];
      all[i] = {static_cast<int>(i), d.x() * d.x() + d.y() * d.y() + d.z() * d.z()};  // summed as the tree does
    }
    const std::size_t count = std::min(found.size(), all.size());
    std::partial_sort_copy(all.begin(), all.end(), found.begin(), found.begin() + static_cast<std::ptrdiff_t>(count),
                           nearer);
    return count;
  }
};

NearestVertexIndex::NearestVertexIndex(std::vector<Point> points) : tree_(std::make_unique<Tree>()) {
  if (points.empty()) throw InputError("a search for near vertices needs at least one vertex");
  require_finite(points);
  tree_->points = std::move(points);
  tree_->index = std::make_unique<Tree::Index>(3, *tree_, nanoflann::KDTreeSingleIndexAdaptorParams(12));
}
NearestVertexIndex::~NearestVertexIndex() = default;
NearestVertexIndex::NearestVertexIndex(NearestVertexIndex&&) noexcept = default;
NearestVertexIndex& NearestVertexIndex::operator=(NearestVertexIndex&&) noexcept = default;

std::size_t NearestVertexIndex::size() const { return tree_->points.size(); }
const std::vector<Point>& NearestVertexIndex::points() const { return tree_->points; }

NearVertex NearestVertexIndex::nearest(const Point& query) const {
  NearVertex found;
  nearest(query, {&found, 1});
  return found;
}

std::vector<NearVertex> NearestVertexIndex::nearest(const Point& query, std::size_t k) const {
  std::vector<NearVertex> found(std::min(k, size()));
  nearest(query, found);
  return found;
}

std::size_t NearestVertexIndex::nearest(const Point& query, std::span<NearVertex> found) const {
  if (found.empty()) return 0;
  // Insertion into a long list costs more than sorting what is near, or all.
  constexpr std::size_t long_list = 256;
  if (found.size() > long_list)
    return found.size() < size() / 8 ? tree_->nearest_of_balls(query, found) : tree_->nearest_of_all(query, found);
  NearestSet set(found);
  tree_->index->findNeighbors(set, query.data(), nanoflann::SearchParams(0, 0.0F, false));
  return set.size();
}

std::vector<NearVertex> NearestVertexIndex::within(const Point& query, double radius) const {
  if (!(radius >= 0)) throw UsageError("a search radius must not be negative");
  return tree_->ball(query, radius * radius);
}

}  // namespace rhizodont
