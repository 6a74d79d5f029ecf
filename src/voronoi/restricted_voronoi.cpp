// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// D.-M. Yan, B. Levy, Y. Liu, F. Sun and W. Wang, "Isotropic remeshing with fast and exact computation of restricted
//   Voronoi diagram", Computer Graphics Forum 28(5), 2009.
//
// Facet by facet: the cells of its corners are known, and a cell's polygon names the cells beside it, so that flooding
// from the corners finds all cells that meet the facet.

#include "voronoi/restricted_voronoi.hpp"

#include "base/option_range.hpp"
#include "rhizodont/error.hpp"
#include "voronoi/cell_clipper.hpp"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace rhizodont {
namespace {

/// Integrals over a part of a cell; places are measured from the site.
struct Moments {
  std::int32_t site = -1;
  double area = 0;
  double mass = 0;
  Eigen::Vector3d mass_times_place = Eigen::Vector3d::Zero();
};

/// Of a convex polygon over which the density is linear on each triangle of the fan from the first corner.
Moments moments_of(std::int32_t site, const std::vector<CellCorner>& polygon) {
  Moments m;
  m.site = site;
  for (std::size_t k = 1; k + 1 < polygon.size(); ++k) {
    const CellCorner &a = polygon[0], &b = polygon[k], &c = polygon[k + 1];
    const double area = 0.5 * (b.place - a.place).cross(c.place - a.place).norm();
    const double density = a.density + b.density + c.density;
    m.area += area;
    m.mass += area / 3 * density;
    m.mass_times_place +=
        area / 12 *
        ((density + a.density) * a.place + (density + b.density) * b.place + (density + c.density) * c.place);
  }
  return m;
}

/// What one block of facets yields; blocks are joined in order.
struct BlockResult {
  std::vector<Triangle> triangles;
  std::vector<std::int32_t> sites;
  std::vector<Moments> moments;
};

/// Floods facets, one thread.
class FacetFlood {
 public:
  FacetFlood(const SiteNeighbours& neighbours, const TriangleMesh& surface, const RestrictedVoronoiOptions& options)
      : clipper_(neighbours), surface_(surface), options_(options), seen_(neighbours.sites().size(), -1) {}

  CellClipper& clipper() { return clipper_; }

  void facet(std::size_t id, const std::vector<std::int32_t>& vertex_sites, BlockResult& out) {
    std::array<const Point*, 3> corners{};
    std::array<double, 3> density{1, 1, 1};
    std::array<std::int32_t, 3> corner_sites{};
    stack_.clear();
    for (std::size_t k = 0; k < 3; ++k) {
      const auto v = static_cast<std::size_t>(surface_.triangles[id][k]);
      corners[k] = &surface_.vertices[v];
      if (!options_.density.empty()) density[k] = options_.density[v];
      corner_sites[k] = vertex_sites[v];
      push(corner_sites[k], id);
    }
    clipper_.set_facet(corners, density, corner_sites);
    while (!stack_.empty()) {
      const std::int32_t i = stack_.back();
      stack_.pop_back();
      const std::vector<CellCorner>& polygon = clipper_.clip_to_cell(i);
      if (polygon.empty()) continue;
      report(i, polygon, out);
      for (const CellCorner& c : polygon)
        if (is_bisector(c.leaving)) push(c.leaving, id);
    }
  }

 private:
  void push(std::int32_t site, std::size_t facet) {
    std::int64_t& seen = seen_[static_cast<std::size_t>(site)];
    if (seen == static_cast<std::int64_t>(facet)) return;
    seen = static_cast<std::int64_t>(facet);
    stack_.push_back(site);
  }

  void report(std::int32_t i, const std::vector<CellCorner>& polygon, BlockResult& out) const {
    const std::size_t n = polygon.size();
    for (std::size_t k = 0; k < n; ++k) {
      const CellLine j = polygon[k > 0 ? k - 1 : n - 1].leaving;
      const CellLine l = polygon[k].leaving;
      if (i < j && i < l) out.triangles.push_back({i, j, l});
    }
    out.sites.push_back(i);
    if (options_.cell_moments) out.moments.push_back(moments_of(i, polygon));
  }

  CellClipper clipper_;
  const TriangleMesh& surface_;
  const RestrictedVoronoiOptions& options_;
  std::vector<std::int64_t> seen_;  // last facet in which the site was met
  std::vector<std::int32_t> stack_;
};

// Sixth powers of differences must not overflow.
bool is_usable(const Point& p) { return (p.array().abs() < 1e45).all(); }

void check_input(const std::vector<Point>& sites, const TriangleMesh& surface,
                 const RestrictedVoronoiOptions& options) {
  require_in_range(options);
  if (sites.empty()) throw InputError("There are no sites to make a Voronoi diagram of.");
  if (surface.triangles.empty()) throw InputError("The guiding surface has no triangles.");
  std::vector<std::int64_t> bad;
  for (std::size_t i = 0; i < sites.size(); ++i)
    if (!is_usable(sites[i])) bad.push_back(static_cast<std::int64_t>(i));
  if (!bad.empty()) throw InputError("Some sites of the Voronoi diagram have no finite position.", bad);
  if (!std::all_of(surface.vertices.begin(), surface.vertices.end(), is_usable))
    throw InputError("The guiding surface has a vertex without a finite position.");
  if (options.density.empty()) return;
  if (options.density.size() != surface.vertices.size())
    throw UsageError("A density is needed for each vertex of the surface, or for none.");
}

void add_moments(const std::vector<BlockResult>& blocks, const std::vector<Point>& sites,
                 const SiteNeighbours& neighbours, RestrictedVoronoi& result) {
  result.cell_area.assign(sites.size(), 0);
  result.cell_mass.assign(sites.size(), 0);
  result.cell_centroid.assign(sites.size(), Point::Zero());
  for (const BlockResult& block : blocks) {
    for (const Moments& m : block.moments) {
      const auto s = static_cast<std::size_t>(neighbours.original(m.site));
      result.cell_area[s] += m.area;
      result.cell_mass[s] += m.mass;
      result.cell_centroid[s] += m.mass_times_place;
    }
  }
  for (std::size_t i = 0; i < sites.size(); ++i) {
    Point& centroid = result.cell_centroid[i];
    if (result.cell_mass[i] > 0) centroid = sites[i] + centroid / result.cell_mass[i];
    // Also where the mass is so small that the division overflows.
    if (!(result.cell_mass[i] > 0) || !centroid.allFinite()) centroid = sites[i];
  }
}

}  // namespace

Triangle lowest_first(Triangle triangle) {
  std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()), triangle.end());
  return triangle;
}

void require_in_range(const RestrictedVoronoiOptions& options) {
  require_ranges("a restricted Voronoi diagram", {{"neighbours", options.neighbours, OptionRange::at_least(1)}});
  for (const double d : options.density)
    require_ranges("a restricted Voronoi diagram", {{"density", d, OptionRange::at_least(0)}});
}

RestrictedVoronoi restricted_voronoi(const std::vector<Point>& sites, const TriangleMesh& surface,
                                     const RestrictedVoronoiOptions& options) {
  check_input(sites, surface, options);
  const SiteNeighbours neighbours(sites, static_cast<std::size_t>(options.neighbours) + 1);
  tbb::enumerable_thread_specific<FacetFlood> floods([&] { return FacetFlood(neighbours, surface, options); });

  std::vector<std::int32_t> vertex_sites(surface.vertices.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, vertex_sites.size(), 512), [&](const auto& range) {
    CellClipper& clipper = floods.local().clipper();
    for (std::size_t v = range.begin(); v < range.end(); ++v) vertex_sites[v] = clipper.site_of(surface.vertices[v]);
  });

  // Fixed blocks, so that sums over cells are taken in the same order for any number of threads.
  constexpr std::size_t block_size = 512;
  const std::size_t facets = surface.triangles.size();
  std::vector<BlockResult> blocks((facets + block_size - 1) / block_size);
  tbb::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t b) {
    FacetFlood& flood = floods.local();
    const std::size_t end = std::min(facets, (b + 1) * block_size);
    for (std::size_t f = b * block_size; f < end; ++f) flood.facet(f, vertex_sites, blocks[b]);
  });

  RestrictedVoronoi result;
  result.site_has_cell.assign(sites.size(), false);
  for (const BlockResult& block : blocks) {
    for (const auto& [i, j, k] : block.triangles)
      result.triangles.push_back(
          lowest_first({neighbours.original(i), neighbours.original(j), neighbours.original(k)}));
    for (const std::int32_t s : block.sites)
      result.site_has_cell[static_cast<std::size_t>(neighbours.original(s))] = true;
  }
  std::sort(result.triangles.begin(), result.triangles.end());
  if (options.cell_moments) add_moments(blocks, sites, neighbours, result);
  return result;
}

}  // namespace rhizodont
