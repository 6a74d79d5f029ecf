// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "mesh/nearest_vertex.hpp"
#include "rhizodont/mesh.hpp"
#include "voronoi/predicates.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

namespace rhizodont {

/// The sites of a diagram in an order in which neighbours are stored near each other, with the nearest of each. Sites
/// are numbered by this order in here; `original` gives the number that the caller knows and that decides ties.
class SiteNeighbours {
 public:
  /// `per_site`: how many are listed at first, at most as many as there are sites.
  SiteNeighbours(const std::vector<Point>& sites, std::size_t per_site);

  const std::vector<Point>& sites() const { return index_.points(); }
  const NearestVertexIndex& index() const { return index_; }
  std::int32_t original(std::int32_t site) const { return order_[static_cast<std::size_t>(site)]; }
  /// Ascending by distance; the first is usually the site itself.
  std::span<const NearVertex> of(std::int32_t site) const {
    return std::span(nearest_).subspan(static_cast<std::size_t>(site) * per_site_, per_site_);
  }

 private:
  std::vector<std::int32_t> order_;
  NearestVertexIndex index_;
  std::size_t per_site_;
  std::vector<NearVertex> nearest_;
};

/// The line of an edge of a cell's polygon: edge i of the facet as -1 - i, the bisector with site j as j.
using CellLine = std::int32_t;
constexpr bool is_bisector(CellLine line) { return line >= 0; }

/// A corner of a cell's polygon: its place, and the line of the edge that leaves it counterclockwise.
struct CellCorner {
  Eigen::Vector3d place;  // from the site, rounded
  double error;           // no less than the distance of `place` from where the corner truly is
  double density;
  CellLine leaving;
};

/// Cuts facets to the cells of sites. Every decision is exact: rounded coordinates decide where their accumulated
/// error allows, the predicates elsewhere. One clipper serves one thread.
class CellClipper {
 public:
  explicit CellClipper(const SiteNeighbours& neighbours) : neighbours_(neighbours), sites_(neighbours.sites()) {}

  /// The site in whose cell q lies.
  std::int32_t site_of(const Point& q);

  /// Corners of a facet, the density there, and their sites as found by `site_of`. The points must outlive the use.
  void set_facet(const std::array<const Point*, 3>& corners, const std::array<double, 3>& density,
                 const std::array<std::int32_t, 3>& corner_sites);

  /// The part of the facet that lies in the cell of a site; empty if there is none. Valid until the next call.
  const std::vector<CellCorner>& clip_to_cell(std::int32_t site);

 private:
  Site site(std::int32_t i) const { return {&sites_[static_cast<std::size_t>(i)], neighbours_.original(i)}; }
  std::span<const NearVertex> longer_list(std::int32_t site, std::size_t than);
  void measure_reach();
  int side(std::int32_t i, std::int32_t j, CellLine arriving, CellLine leaving) const;
  bool cut(std::int32_t i, std::int32_t j);
  CellCorner meet(std::size_t a, std::size_t b, CellLine leaving) const;

  const SiteNeighbours& neighbours_;
  const std::vector<Point>& sites_;
  std::unordered_map<std::int32_t, std::vector<NearVertex>> longer_;
  std::array<const Point*, 3> corner_{};
  std::array<double, 3> density_{};
  std::array<std::int32_t, 3> corner_site_{};
  std::vector<CellCorner> polygon_;
  std::vector<CellCorner> clipped_;
  std::vector<double> height_;  // per corner: rounded height over the bisector at hand, times the sites' distance
  std::vector<double> bound_;   // per corner: no less than the error of its height
  std::vector<int> sides_;
  double reach_ = 0;  // no less than the distance from the site to the farthest corner
};

}  // namespace rhizodont
