// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// D.-M. Yan, B. Levy, Y. Liu, F. Sun and W. Wang, "Isotropic remeshing with fast and exact computation of restricted
//   Voronoi diagram", Computer Graphics Forum 28(5), 2009.
// B. Levy and N. Bonneel, "Variational anisotropic surface meshing with Voronoi parallel linear enumeration", 2013:
//   the security radius that ends the clipping of a cell.
//
// A cell of a site within one facet is a convex polygon. It is kept as the cyclic list of the lines its edges lie on:
// an edge of the facet or the bisector with another site. A vertex is where two consecutive lines meet, so its side of
// a further bisector follows from input points alone (side1, side2 or side3), whatever the rounding of its coordinates.

#include "voronoi/restricted_voronoi.hpp"

#include "mesh/nearest_vertex.hpp"
#include "rhizodont/error.hpp"
#include "voronoi/predicates.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace rhizodont {
namespace {

/// The line of a polygon edge: facet edge i as -1 - i, the bisector with site j as j.
using Line = std::int32_t;
constexpr bool is_bisector(Line line) { return line >= 0; }
constexpr int facet_edge(Line line) { return -1 - line; }

/// Vertex of a cell's polygon: its place (rounded) and the line of the edge that leaves it counterclockwise.
struct Corner {
  Point place;
  Line leaving;
};

struct CellMoments {
  std::int32_t site;
  double area;
  Point area_times_centroid;
};

/// What one block of facets yields; blocks are joined in order.
struct BlockResult {
  std::vector<Triangle> triangles;
  std::vector<std::int32_t> sites;
  std::vector<CellMoments> moments;
};

class Clipper {
 public:
  Clipper(const std::vector<Point>& sites, const NearestVertexIndex& index,
          const std::vector<std::vector<NearVertex>>& neighbours, const RestrictedVoronoiOptions& options)
      : sites_(sites), index_(index), neighbours_(neighbours), options_(options), seen_(sites.size(), -1) {}

  void facet(const TriangleMesh& surface, std::int32_t id, BlockResult& out) {
    for (int i = 0; i < 3; ++i) corner_[i] = &surface.vertices[static_cast<std::size_t>(surface.triangles[id][i])];
    stack_.clear();
    push(start_site(*corner_[0]), id);
    while (!stack_.empty()) {
      const std::int32_t i = stack_.back();
      stack_.pop_back();
      clip_to_cell(i);
      if (polygon_.empty()) continue;
      report(i, out);
      for (const Corner& c : polygon_)
        if (is_bisector(c.leaving)) push(c.leaving, id);
    }
  }

 private:
  void push(std::int32_t site, std::int32_t facet) {
    if (seen_[site] == facet) return;
    seen_[site] = facet;
    stack_.push_back(site);
  }

  Site site(std::int32_t i) const { return {&sites_[i], i}; }

  /// The site whose cell holds q. The kd-tree's distances are rounded, so all that come close to the nearest compete.
  std::int32_t start_site(const Point& q) const {
    std::size_t k = 8;
    auto near = index_.nearest(q, k);
    const auto tied = [&](const NearVertex& n) {
      return n.squared_distance <= near.front().squared_distance * (1 + 1e-9) + 1e-18;
    };
    while (near.size() == k && tied(near.back())) near = index_.nearest(q, k *= 2);
    std::int32_t best = near.front().index;
    for (const NearVertex& n : near)
      if (n.index != best && tied(n) && side1(site(best), site(n.index), q) < 0) best = n.index;
    return best;
  }

  /// Leaves in polygon_ the part of the facet that lies in the cell of site i.
  void clip_to_cell(std::int32_t i) {
    polygon_.clear();
    for (int e = 0; e < 3; ++e) polygon_.push_back({*corner_[e], static_cast<Line>(-1 - e)});
    const std::vector<NearVertex>* list = &neighbours_[i];
    std::size_t next = 0;
    double reach = squared_reach(i);
    while (true) {
      for (; next < list->size(); ++next) {
        const NearVertex& n = (*list)[next];
        // A site farther than twice the farthest point of the polygon cannot cut it; the slack admits touching.
        if (n.squared_distance > 4.1 * reach) return;
        if (n.index == i) continue;
        if (cut(i, n.index)) {
          if (polygon_.empty()) return;
          reach = squared_reach(i);
        }
      }
      if (list->size() >= sites_.size()) return;
      longer_ = index_.nearest(sites_[i], std::min(sites_.size(), 2 * list->size() + 1));
      list = &longer_;
    }
  }

  double squared_reach(std::int32_t i) const {
    double reach = 0;
    for (const Corner& c : polygon_) reach = std::max(reach, (c.place - sites_[i]).squaredNorm());
    return reach;
  }

  /// Side of the corner where `arriving` and `leaving` meet: +1 nearer to site i than to site j.
  int side(std::int32_t i, std::int32_t j, Line arriving, Line leaving) const {
    if (!is_bisector(arriving) && !is_bisector(leaving)) return side1(site(i), site(j), *corner_[facet_edge(leaving)]);
    if (is_bisector(arriving) && is_bisector(leaving))
      return side3(site(i), site(arriving), site(leaving), site(j), *corner_[0], *corner_[1], *corner_[2]);
    const Line bisector = is_bisector(arriving) ? arriving : leaving;
    const int edge = facet_edge(is_bisector(arriving) ? leaving : arriving);
    return side2(site(i), site(bisector), site(j), *corner_[edge], *corner_[(edge + 1) % 3]);
  }

  /// Where the edge from a to b meets the bisector of i and j, by distances to it.
  Point meet(std::int32_t i, std::int32_t j, const Point& a, const Point& b) const {
    const Eigen::Vector3d normal = sites_[j] - sites_[i];
    const Point middle = 0.5 * (sites_[i] + sites_[j]);
    const double da = normal.dot(a - middle);
    const double db = normal.dot(b - middle);
    const double span = da - db;
    const double t = std::abs(span) > 0 ? std::clamp(da / span, 0.0, 1.0) : 0.5;
    return a + t * (b - a);
  }

  /// Keeps the part of the polygon on the side of i; false if nothing was cut off.
  bool cut(std::int32_t i, std::int32_t j) {
    const std::size_t n = polygon_.size();
    sides_.resize(n);
    bool any_far = false;
    bool any_near = false;
    for (std::size_t k = 0; k < n; ++k) {
      sides_[k] = side(i, j, polygon_[(k + n - 1) % n].leaving, polygon_[k].leaving);
      (sides_[k] < 0 ? any_far : any_near) = true;
    }
    if (!any_far) return false;
    clipped_.clear();
    if (any_near) {
      for (std::size_t k = 0; k < n; ++k) {
        const Corner& here = polygon_[k];
        const Corner& ahead = polygon_[(k + 1) % n];
        const int side_ahead = sides_[(k + 1) % n];
        if (sides_[k] > 0) {
          clipped_.push_back(here);
          if (side_ahead < 0) clipped_.push_back({meet(i, j, here.place, ahead.place), j});
        } else if (side_ahead > 0) {
          clipped_.push_back({meet(i, j, here.place, ahead.place), here.leaving});
        }
      }
    }
    polygon_.swap(clipped_);
    return true;
  }

  void report(std::int32_t i, BlockResult& out) const {
    const std::size_t n = polygon_.size();
    for (std::size_t k = 0; k < n; ++k) {
      const Line j = polygon_[(k + n - 1) % n].leaving;
      const Line l = polygon_[k].leaving;
      if (is_bisector(j) && is_bisector(l) && i < j && i < l) out.triangles.push_back({i, j, l});
    }
    out.sites.push_back(i);
    if (!options_.cell_moments) return;
    CellMoments m{i, 0, Point::Zero()};
    for (std::size_t k = 1; k + 1 < n; ++k) {
      const Point &a = polygon_[0].place, &b = polygon_[k].place, &c = polygon_[k + 1].place;
      const double area = 0.5 * (b - a).cross(c - a).norm();
      m.area += area;
      m.area_times_centroid += area / 3 * (a + b + c);
    }
    out.moments.push_back(m);
  }

  const std::vector<Point>& sites_;
  const NearestVertexIndex& index_;
  const std::vector<std::vector<NearVertex>>& neighbours_;
  const RestrictedVoronoiOptions& options_;
  std::vector<std::int32_t> seen_;  // last facet in which the site was met
  std::vector<std::int32_t> stack_;
  std::vector<NearVertex> longer_;
  std::array<const Point*, 3> corner_{};
  std::vector<Corner> polygon_;
  std::vector<Corner> clipped_;
  std::vector<int> sides_;
};

void check_input(const std::vector<Point>& sites, const TriangleMesh& surface) {
  if (sites.empty()) throw InputError("There are no sites to make a Voronoi diagram of.");
  if (surface.triangles.empty()) throw InputError("The guiding surface has no triangles.");
  std::vector<std::int64_t> bad;
  for (std::size_t i = 0; i < sites.size(); ++i)
    if (!sites[i].allFinite()) bad.push_back(static_cast<std::int64_t>(i));
  if (!bad.empty()) throw InputError("Some sites of the Voronoi diagram have no finite position.", bad);
  for (const Point& p : surface.vertices)
    if (!p.allFinite()) throw InputError("The guiding surface has a vertex without a finite position.");
}

}  // namespace

Triangle lowest_first(Triangle triangle) {
  std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()), triangle.end());
  return triangle;
}

RestrictedVoronoi restricted_voronoi(const std::vector<Point>& sites, const TriangleMesh& surface,
                                     const RestrictedVoronoiOptions& options) {
  check_input(sites, surface);
  const NearestVertexIndex index(sites);
  std::vector<std::vector<NearVertex>> neighbours(sites.size());
  tbb::parallel_for(std::size_t{0}, sites.size(), [&](std::size_t i) {
    neighbours[i] = index.nearest(sites[i], std::min(sites.size(), static_cast<std::size_t>(options.neighbours) + 1));
  });

  // Fixed blocks, so that sums over cells are taken in the same order for any number of threads.
  constexpr std::size_t block_size = 1024;
  const std::size_t facets = surface.triangles.size();
  std::vector<BlockResult> blocks((facets + block_size - 1) / block_size);
  tbb::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t b) {
    Clipper clipper(sites, index, neighbours, options);
    const std::size_t end = std::min(facets, (b + 1) * block_size);
    for (std::size_t f = b * block_size; f < end; ++f) clipper.facet(surface, static_cast<std::int32_t>(f), blocks[b]);
  });

  RestrictedVoronoi result;
  result.site_has_cell.assign(sites.size(), false);
  if (options.cell_moments) {
    result.cell_area.assign(sites.size(), 0);
    result.cell_centroid.assign(sites.size(), Point::Zero());
  }
  for (const BlockResult& block : blocks) {
    result.triangles.insert(result.triangles.end(), block.triangles.begin(), block.triangles.end());
    for (const std::int32_t s : block.sites) result.site_has_cell[static_cast<std::size_t>(s)] = true;
    for (const CellMoments& m : block.moments) {
      result.cell_area[static_cast<std::size_t>(m.site)] += m.area;
      result.cell_centroid[static_cast<std::size_t>(m.site)] += m.area_times_centroid;
    }
  }
  for (std::size_t i = 0; i < result.cell_area.size(); ++i) {
    if (result.cell_area[i] > 0)
      result.cell_centroid[i] /= result.cell_area[i];
    else
      result.cell_centroid[i] = sites[i];
  }
  std::sort(result.triangles.begin(), result.triangles.end());
  return result;
}

}  // namespace rhizodont
