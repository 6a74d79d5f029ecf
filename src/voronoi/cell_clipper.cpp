// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// D.-M. Yan, B. Levy, Y. Liu, F. Sun and W. Wang, "Isotropic remeshing with fast and exact computation of restricted
//   Voronoi diagram", Computer Graphics Forum 28(5), 2009.
// B. Levy and N. Bonneel, "Variational anisotropic surface meshing with Voronoi parallel linear enumeration", 2013:
//   the security radius that ends the clipping of a cell.
//
// A cell of a site within one facet is a convex polygon, kept as the cyclic list of the lines its edges lie on. A
// corner is where two consecutive lines meet, so its side of a further bisector follows from input points alone
// (side1, side2 or side3). That is only asked for where the corner's rounded coordinates cannot tell: each carries a
// bound of its distance from the true corner, and a height over the bisector that exceeds what this bound and the
// rounding of the height itself (u = 2^-53 per operation) can amount to has the right sign.

#include "voronoi/cell_clipper.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace rhizodont {
namespace {

// Sums of fewer than 8 rounded operations err by at most 8 u, relative to the sum of magnitudes.
constexpr double rounding = 8 * std::numeric_limits<double>::epsilon() / 2;
constexpr double underflow = 64 * std::numeric_limits<double>::min();
constexpr double outwards = 1 + 1e-9;  // covers the rounding of the bounds themselves

constexpr int facet_edge(CellLine line) { return -1 - line; }

/// Indices of points along Morton's space-filling curve.
std::vector<std::int32_t> along_a_curve(const std::vector<Point>& points) {
  Eigen::AlignedBox3d box;
  for (const Point& p : points) box.extend(p);
  constexpr int bits = 10;  // per axis
  const double widest = std::max(box.sizes().maxCoeff(), std::numeric_limits<double>::min());
  std::vector<std::pair<std::uint32_t, std::int32_t>> keys(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d place = (points[i] - box.min()) / widest * ((1 << bits) - 1);
    std::uint32_t key = 0;
    for (int bit = bits - 1; bit >= 0; --bit)
      for (int axis = 0; axis < 3; ++axis) key = 2 * key + ((static_cast<std::uint32_t>(place[axis]) >> bit) & 1);
    keys[i] = {key, static_cast<std::int32_t>(i)};
  }
  std::sort(keys.begin(), keys.end());
  std::vector<std::int32_t> order(points.size());
  std::transform(keys.begin(), keys.end(), order.begin(), [](const auto& key) { return key.second; });
  return order;
}

std::vector<Point> in_order(const std::vector<Point>& points, const std::vector<std::int32_t>& order) {
  std::vector<Point> result;
  result.reserve(points.size());
  for (const std::int32_t i : order) result.push_back(points[static_cast<std::size_t>(i)]);
  return result;
}

}  // namespace

SiteNeighbours::SiteNeighbours(const std::vector<Point>& sites, std::size_t per_site)
    : order_(along_a_curve(sites)),
      index_(in_order(sites, order_)),
      per_site_(std::min(per_site, sites.size())),
      nearest_(per_site_ * sites.size()) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, sites.size(), 256), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i)
      index_.nearest(index_.points()[i], std::span(nearest_).subspan(i * per_site_, per_site_));
  });
}

/// A list at least twice as long as `than`, or of all sites.
std::span<const NearVertex> CellClipper::longer_list(std::int32_t site, std::size_t than) {
  std::vector<NearVertex>& list = longer_[site];
  if (list.size() <= than) {
    list.resize(std::min(sites_.size(), 2 * than + 8));
    neighbours_.index().nearest(sites_[static_cast<std::size_t>(site)], list);
  }
  return list;
}

std::int32_t CellClipper::site_of(const Point& q) {
  // The tree's distances are rounded, so that its answer is only a start: whoever is nearer takes over.
  std::int32_t i = neighbours_.index().nearest(q).index;
  std::span<const NearVertex> list = neighbours_.of(i);
  for (std::size_t next = 0;; ++next) {
    const Eigen::Vector3d place = q - sites_[static_cast<std::size_t>(i)];
    const double distance = place.norm();
    if (next == list.size()) {
      if (list.size() == sites_.size()) return i;
      list = longer_list(i, list.size());
    }
    const NearVertex& n = list[next];
    if (n.squared_distance > 4 * outwards * distance * distance) return i;
    if (n.index == i) continue;
    const Eigen::Vector3d normal = sites_[static_cast<std::size_t>(n.index)] - sites_[static_cast<std::size_t>(i)];
    const double half_square = 0.5 * normal.squaredNorm();
    const double bound = rounding * (std::sqrt(2 * half_square) * distance + half_square) + underflow;
    if (half_square - normal.dot(place) > bound) continue;
    if (side1(site(i), site(n.index), q) > 0) continue;
    i = n.index;
    list = neighbours_.of(i);
    next = static_cast<std::size_t>(-1);
  }
}

void CellClipper::set_facet(const std::array<const Point*, 3>& corners, const std::array<double, 3>& density,
                            const std::array<std::int32_t, 3>& corner_sites) {
  corner_ = corners;
  density_ = density;
  corner_site_ = corner_sites;
}

const std::vector<CellCorner>& CellClipper::clip_to_cell(std::int32_t i) {
  polygon_.clear();
  for (std::size_t e = 0; e < 3; ++e) {
    const Eigen::Vector3d place = *corner_[e] - sites_[static_cast<std::size_t>(i)];
    polygon_.push_back({place, rounding * place.norm(), density_[e], -1 - static_cast<CellLine>(e)});
  }
  // Cells are convex: with its corners the whole facet is inside.
  if (corner_site_[0] == i && corner_site_[1] == i && corner_site_[2] == i) return polygon_;
  measure_reach();
  std::span<const NearVertex> list = neighbours_.of(i);
  for (std::size_t next = 0;; ++next) {
    if (next == list.size()) {
      if (list.size() == sites_.size()) return polygon_;
      list = longer_list(i, list.size());
    }
    const NearVertex& n = list[next];
    // A site farther than twice the farthest point of the polygon cannot cut it.
    if (n.squared_distance > 4 * outwards * reach_ * reach_) return polygon_;
    if (n.index == i || !cut(i, n.index)) continue;
    if (polygon_.empty()) return polygon_;
    measure_reach();
  }
}

void CellClipper::measure_reach() {
  double squared = 0;
  double error = 0;
  for (const CellCorner& c : polygon_) {
    squared = std::max(squared, c.place.squaredNorm());
    error = std::max(error, c.error);
  }
  reach_ = outwards * std::sqrt(squared) + error;
}

/// Side of the corner where `arriving` and `leaving` meet: +1 nearer to site i than to site j.
int CellClipper::side(std::int32_t i, std::int32_t j, CellLine arriving, CellLine leaving) const {
  const auto corner = [&](int edge) -> const Point& { return *corner_[static_cast<std::size_t>(edge % 3)]; };
  if (!is_bisector(arriving) && !is_bisector(leaving)) return side1(site(i), site(j), corner(facet_edge(leaving)));
  if (is_bisector(arriving) && is_bisector(leaving))
    return side3(site(i), site(arriving), site(leaving), site(j), corner(0), corner(1), corner(2));
  const CellLine bisector = is_bisector(arriving) ? arriving : leaving;
  const int edge = facet_edge(is_bisector(arriving) ? leaving : arriving);
  return side2(site(i), site(bisector), site(j), corner(edge), corner(edge + 1));
}

/// Where the edge from corner a to corner b, on different sides of the bisector at hand, meets it.
CellCorner CellClipper::meet(std::size_t a, std::size_t b, CellLine leaving) const {
  const CellCorner& from = polygon_[a];
  const CellCorner& to = polygon_[b];
  const double span = std::abs(height_[a] - height_[b]);
  const double t = span > 0 ? std::clamp(height_[a] / (height_[a] - height_[b]), 0.0, 1.0) : 0.5;
  const Eigen::Vector3d along = to.place - from.place;
  // With true heights h of opposite signs, |t - h_a / (h_a - h_b)| <= bound / span; where the bounds exceed the span,
  // the meeting point is only known to be on the edge.
  const double bound = std::max(bound_[a], bound_[b]);
  const double uncertain = span > 2 * bound ? std::min(2 * bound / span + rounding, 1.0) : 1.0;
  const double error = std::max(from.error, to.error);
  return {from.place + t * along, outwards * (error + uncertain * (along.norm() + 2 * error) + rounding * reach_),
          from.density + t * (to.density - from.density), leaving};
}

/// Keeps the part of the polygon on the side of i; false if nothing was cut off.
bool CellClipper::cut(std::int32_t i, std::int32_t j) {
  const Eigen::Vector3d normal = sites_[static_cast<std::size_t>(j)] - sites_[static_cast<std::size_t>(i)];
  const double half_square = 0.5 * normal.squaredNorm();
  const double length = outwards * std::sqrt(2 * half_square);
  const double bound = rounding * (length * reach_ + half_square) + underflow;
  const std::size_t n = polygon_.size();
  sides_.resize(n);
  height_.resize(n);
  bound_.resize(n);
  bool any_far = false;
  bool any_near = false;
  for (std::size_t k = 0; k < n; ++k) {
    const double height = half_square - normal.dot(polygon_[k].place);
    height_[k] = height;
    bound_[k] = length * polygon_[k].error + bound;
    if (height > bound_[k])
      sides_[k] = 1;
    else if (height < -bound_[k])
      sides_[k] = -1;
    else
      sides_[k] = side(i, j, polygon_[(k + n - 1) % n].leaving, polygon_[k].leaving);
    (sides_[k] < 0 ? any_far : any_near) = true;
  }
  if (!any_far) return false;
  clipped_.clear();
  for (std::size_t k = 0; any_near && k < n; ++k) {
    const std::size_t ahead = k + 1 < n ? k + 1 : 0;
    if (sides_[k] > 0) {
      clipped_.push_back(polygon_[k]);
      if (sides_[ahead] < 0) clipped_.push_back(meet(k, ahead, j));
    } else if (sides_[ahead] > 0) {
      clipped_.push_back(meet(k, ahead, polygon_[k].leaving));
    }
  }
  polygon_.swap(clipped_);
  return true;
}

}  // namespace rhizodont
