// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/nearest_vertex.hpp"

#include "mesh/mesh_checks.hpp"
#include "rhizodont/error.hpp"

#include <nanoflann.hpp>

#include <algorithm>
#include <limits>

namespace rhizodont {
namespace {

// Gathers everything within a squared radius, the bound included (nanoflann's own radius set excludes it, and its set
// of the k nearest keeps whichever of equally near points the tree meets first).
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
  // A little more than the bound: the tree adds up box distances with rounding errors of its own.
  double worstDist() const { return bound_ * (1 + 1e-12) + std::numeric_limits<double>::min(); }

 private:
  double bound_;
  std::vector<NearVertex>& found_;
};

bool nearer(const NearVertex& a, const NearVertex& b) {
  return a.squared_distance != b.squared_distance ? a.squared_distance < b.squared_distance : a.index < b.index;
}

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

NearVertex NearestVertexIndex::nearest(const Point& query) const { return nearest(query, 1).front(); }

std::vector<NearVertex> NearestVertexIndex::nearest(const Point& query, std::size_t k) const {
  k = std::min(k, size());
  if (k == 0) return {};
  std::vector<std::uint32_t> indices(k);
  std::vector<double> squared_distances(k);
  tree_->index->knnSearch(query.data(), k, indices.data(), squared_distances.data());
  // All points as near as the k-th, so that a tie is decided by index and not by the tree.
  std::vector<NearVertex> found = tree_->ball(query, squared_distances.back());
  found.resize(std::min(found.size(), k));
  return found;
}

std::vector<NearVertex> NearestVertexIndex::within(const Point& query, double radius) const {
  if (!(radius >= 0)) throw UsageError("a search radius must not be negative");
  return tree_->ball(query, radius * radius);
}

}  // namespace rhizodont
