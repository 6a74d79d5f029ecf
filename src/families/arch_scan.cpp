// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Thinning: edge collapse of CGAL; P. Lindstrom, G. Turk, "Fast and memory efficient polygonal simplification", 1998.
#include "families/arch_scan.hpp"

#include "base/disjoint_sets.hpp"
#include "families/wave_noise.hpp"
#include "mesh/adjacency.hpp"
#include "mesh/geometry.hpp"
#include "mesh/nearest_vertex.hpp"
#include "mesh/smooth_functions.hpp"
#include "mesh/surface_mesh.hpp"

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Count_stop_predicate.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Edge_length_cost.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Midpoint_placement.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>

#include <boost/optional.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <numbers>
#include <utility>

namespace rhizodont {
namespace {

/// Keeps these vertices and the triangles between them.
void keep_vertices(ScanSurface& scan, const std::vector<bool>& keep) {
  std::vector<std::int32_t> number(keep.size(), -1);
  ScanSurface kept;
  std::erase_if(scan.mesh.triangles, [&](const Triangle& t) {
    return !std::all_of(t.begin(), t.end(), [&](std::int32_t v) { return keep[static_cast<std::size_t>(v)]; });
  });
  for (Triangle& t : scan.mesh.triangles)
    for (std::int32_t& v : t) {
      std::int32_t& n = number[static_cast<std::size_t>(v)];
      if (n < 0) {
        n = static_cast<std::int32_t>(kept.mesh.vertices.size());
        kept.mesh.vertices.push_back(scan.mesh.vertices[static_cast<std::size_t>(v)]);
        kept.fdi.push_back(scan.fdi[static_cast<std::size_t>(v)]);
      }
      v = n;
    }
  kept.mesh.triangles = std::move(scan.mesh.triangles);
  scan = std::move(kept);
}

/// Vertices whose triangles form more than one fan, or that have an edge with more than two triangles.
std::vector<bool> pinched_vertices(const TriangleMesh& mesh) {
  std::vector<bool> pinched(mesh.vertices.size(), false);
  const EdgeTable edges = edge_table(mesh);
  std::vector<int> borders(mesh.vertices.size(), 0);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const int triangles = edges.triangle_count(e);
    for (const int v : edges.vertices[e]) {
      if (triangles == 1) ++borders[static_cast<std::size_t>(v)];
      if (triangles > 2) pinched[static_cast<std::size_t>(v)] = true;
    }
  }
  for (std::size_t v = 0; v < borders.size(); ++v)
    if (borders[v] > 2) pinched[v] = true;
  return pinched;
}

/// Where gum is measured from: teeth, and ridges where there are none.
std::vector<Point> landmarks(const ArchCrowns& arch, const ScanSurface& scan) {
  std::vector<Point> points;
  for (std::size_t v = 0; v < scan.fdi.size(); ++v)
    if (scan.fdi[v] != 0) points.push_back(scan.mesh.vertices[v]);
  std::size_t first = 0, last = arch.crowns.size() - 1;
  while (first < last && arch.crowns[first].ghost) ++first;
  while (last > first && arch.crowns[last].ghost) --last;
  for (std::size_t i = first; i <= last; ++i) {
    const ArchCrown& crown = arch.crowns[i];
    if (!crown.ghost) continue;
    for (std::size_t k = 0; k < rim_sectors; k += 4) {
      const double angle = 2 * std::numbers::pi * static_cast<double>(k) / rim_sectors;
      const Point local(0.8 * crown.rim.radius[k] * std::cos(angle), 0.8 * crown.rim.radius[k] * std::sin(angle),
                        crown.rim.height[k] - 1.5);
      points.emplace_back(crown.to_work * local);
    }
  }
  return points;
}

/// Edge length times a factor that changes over the scan.
class UnevenCost {
 public:
  explicit UnevenCost(std::vector<double> factors) : factors_(std::move(factors)) {}
  template <class Profile, class Placement>
  boost::optional<typename Profile::FT> operator()(const Profile& profile, const Placement&) const {
    const double a = factors_[static_cast<std::size_t>(profile.v0())],
                 b = factors_[static_cast<std::size_t>(profile.v1())];
    return 0.5 * (a + b) * std::sqrt(CGAL::to_double(CGAL::squared_distance(profile.p0(), profile.p1())));
  }

 private:
  std::vector<double> factors_;
};

}  // namespace

void drop_crumbs(ScanSurface& scan, std::size_t least) {
  for (int round = 0; round < 6; ++round) {
    std::vector<bool> keep = pinched_vertices(scan.mesh);
    if (std::find(keep.begin(), keep.end(), true) == keep.end()) break;
    keep.flip();
    keep_vertices(scan, keep);
  }
  DisjointSets sets(scan.mesh.vertices.size());
  const auto piece = [&](std::size_t v) { return static_cast<std::size_t>(sets.find(static_cast<int>(v))); };
  for (const Triangle& t : scan.mesh.triangles) {
    sets.join(t[0], t[1]);
    sets.join(t[0], t[2]);
  }
  std::vector<std::size_t> triangles(scan.mesh.vertices.size(), 0);
  for (const Triangle& t : scan.mesh.triangles) ++triangles[piece(static_cast<std::size_t>(t[0]))];
  std::vector<bool> keep(scan.mesh.vertices.size());
  for (std::size_t v = 0; v < keep.size(); ++v) keep[v] = triangles[piece(v)] >= least;
  keep_vertices(scan, keep);
}

ScanExtent draw_extent(const ArchCrowns& arch, RandomStream& random, const ArchDrawOptions& options) {
  ScanExtent extent;
  extent.buccal = random.uniform(3, 10);
  extent.oral = random.uniform(2.5, 10);
  extent.behind = random.uniform(1.0, 8);
  extent.whole_palate = random.chance(0.75);
  extent.palate_end = random.uniform(-5, 12);
  extent.model = random.chance(options.model_share);
  extent.partial = !extent.model && random.chance(options.partial_share);
  if (extent.partial) {
    std::size_t first = random.index(11);
    std::size_t teeth = 4 + random.index(7);
    if (random.chance(0.3)) first = 7, teeth = 9;  // half an arch and a little
    if (random.chance(0.2)) first = 0, teeth = 9;
    const std::size_t last = std::min(first + teeth, arch.crowns.size()) - 1;
    extent.from = arch.crowns[first].along - random.uniform(0.2, 0.7) * arch.crowns[first].width;
    extent.to = arch.crowns[last].along + random.uniform(0.2, 0.7) * arch.crowns[last].width;
  }
  return extent;
}

void trim(const ArchCrowns& arch, const ArchFields& fields, const ScanExtent& extent, RandomStream& random,
          ScanSurface& scan) {
  const std::vector<Point> marks = landmarks(arch, scan);
  if (marks.empty()) return;
  const NearestVertexIndex index(marks);
  const WaveNoise slow(random, 12, 40), ragged(random, 1.5, 6);
  const double slow_share = random.uniform(0.1, 0.45), ragged_mm = random.uniform(0.1, 0.7);
  double back = 1e9, first = 1e9, last = -1e9;
  for (const ArchCrown& crown : arch.crowns) {
    if (crown.ghost) continue;
    back = std::min(back, crown.to_work.translation().z());
    first = std::min(first, crown.along - 0.4 * crown.width);
    last = std::max(last, crown.along + 0.4 * crown.width);
  }
  // Here and there the scanner saw more.
  struct Flap {
    Point at;
    double more, width;
  };
  std::vector<Flap> flaps;
  for (std::uint64_t n = random.index(5); n > 0; --n)
    flaps.push_back({marks[random.index(marks.size())], random.uniform(2, 7), random.uniform(2, 5)});
  std::map<int, std::pair<std::size_t, std::size_t>> seen;  // per tooth: kept, all
  std::vector<bool> keep(scan.fdi.size());
  for (std::size_t v = 0; v < keep.size(); ++v) {
    const Point& p = scan.mesh.vertices[v];
    const double along = fields.plan.sample(fields.plan.along, p.x(), p.z()),
                 off = fields.plan.sample(fields.plan.off, p.x(), p.z());
    const double noise = ragged_mm * ragged(p);
    bool kept = scan.fdi[v] != 0;
    if (!kept) {
      const double away = std::sqrt(index.nearest(p).squared_distance);
      double limit = off > 0 ? extent.buccal : extent.oral;
      if (along < first || along > last) limit = std::min(limit, extent.behind);
      limit *= std::max(0.25, 1 + slow_share * slow(p));
      for (const Flap& flap : flaps)
        limit += flap.more * std::exp(-(p - flap.at).squaredNorm() / (2 * flap.width * flap.width));
      kept = away < limit + noise;
      if (arch.jaw == Jaw::upper && extent.whole_palate && off < -3 && p.z() > back + extent.palate_end + noise)
        kept = kept || fields.plan.sample(fields.plan.level, p.x(), p.z()) > -500;
    }
    if (extent.partial) kept = kept && along > extent.from + noise && along < extent.to + noise;
    keep[v] = kept;
    if (scan.fdi[v] != 0) {
      auto& [some, all] = seen[scan.fdi[v]];
      some += kept ? 1 : 0;
      ++all;
    }
  }
  // Of a tooth at the scan's end too little may be left to be one.
  for (std::size_t v = 0; v < keep.size(); ++v)
    if (scan.fdi[v] != 0 && 5 * seen[scan.fdi[v]].first < 2 * seen[scan.fdi[v]].second) keep[v] = false;
  keep_vertices(scan, keep);
  drop_crumbs(scan, 60);
}

void spoil(const ArchCrowns& arch, double amount, RandomStream& random, ScanSurface& scan) {
  if (amount <= 0 || scan.mesh.vertices.empty()) return;
  const auto how_many = [&](double mean) { return static_cast<int>(amount * mean * -std::log(1 - random.uniform())); };
  std::vector<bool> keep(scan.fdi.size(), true);
  const auto any_vertex = [&] { return random.index(scan.mesh.vertices.size()); };
  const WaveNoise ragged(random, 0.8, 3);
  for (int n = how_many(3); n > 0; --n) {
    std::size_t at = any_vertex();
    for (int again = 0; again < 3 && scan.fdi[at] != 0; ++again) at = any_vertex();
    const Point centre = scan.mesh.vertices[at];
    const double size = random.uniform(0.3, 1.3) + (random.chance(0.1) ? random.uniform(0, 3) : 0);
    for (std::size_t v = 0; v < keep.size(); ++v)
      if ((scan.mesh.vertices[v] - centre).norm() < size * (1 + 0.25 * ragged(scan.mesh.vertices[v]))) keep[v] = false;
  }
  const std::vector<Eigen::Vector3d> normals = vertex_normals(scan.mesh);
  std::vector<Point> moved = scan.mesh.vertices;
  for (int n = how_many(4); n > 0; --n) {
    const Point centre = scan.mesh.vertices[any_vertex()];
    const double size = random.uniform(0.4, 1.6), height = random.uniform(-0.2, 0.7) * size;
    for (std::size_t v = 0; v < moved.size(); ++v) {
      const double squared = (scan.mesh.vertices[v] - centre).squaredNorm() / (size * size);
      if (squared < 6) moved[v] += height * std::exp(-squared) * normals[v];
    }
  }
  scan.mesh.vertices = std::move(moved);
  keep_vertices(scan, keep);
  drop_crumbs(scan, 40);
  // Lip, cheek, tongue, cotton: loose leaves beside the arch.
  for (int n = how_many(0.7); n > 0; --n) {
    const double along = random.uniform(0, arch.curve.length()),
                 away = random.uniform(9, 18) * (random.chance(0.7) ? 1 : -1);
    const Eigen::Vector2d plan = arch.curve.at(along) + away * arch.outward_at(along);
    const Point centre(plan.x(), random.uniform(-8, 4), plan.y());
    const Eigen::Vector3d normal =
        Eigen::Vector3d(random.normal(0.0, 1.0), random.normal(0.0, 1.0), random.normal(0.0, 1.0)).normalized();
    const Eigen::Vector3d u = normal.unitOrthogonal(), w = normal.cross(u);
    const WaveNoise wave(random, 4, 12), edge(random, 2, 6);
    const double size = random.uniform(1, 5), step = 0.5;
    const int half = static_cast<int>(std::ceil(1.5 * size / step)), row = 2 * half + 1;
    const auto start = static_cast<std::int32_t>(scan.mesh.vertices.size());
    std::vector<bool> there;
    for (int i = -half; i <= half; ++i)
      for (int k = -half; k <= half; ++k) {
        const Point flat = centre + step * (i * u + k * w);
        there.push_back(step * std::hypot(i, k) < size * (1 + 0.25 * edge(flat)));
        scan.mesh.vertices.emplace_back(flat + 0.6 * wave(flat) * normal);
        scan.fdi.push_back(0);
      }
    for (int i = 0; i + 1 < row; ++i)
      for (int k = 0; k + 1 < row; ++k) {
        const std::int32_t a = i * row + k;
        const auto is = [&](std::int32_t v) { return there[static_cast<std::size_t>(v)]; };
        if (!is(a) || !is(a + 1) || !is(a + row) || !is(a + row + 1)) continue;
        scan.mesh.triangles.push_back({start + a, start + a + row, start + a + 1});
        scan.mesh.triangles.push_back({start + a + 1, start + a + row, start + a + row + 1});
      }
    drop_crumbs(scan, 4);
  }
}

void thin(std::size_t triangles, RandomStream& random, ScanSurface& scan) {
  if (scan.mesh.triangles.size() <= triangles) return;
  namespace SMS = CGAL::Surface_mesh_simplification;
  const WaveNoise uneven(random, 10, 40);
  const double share = random.uniform(0, 0.3), enamel = random.chance(0.4) ? random.uniform(1, 1.8) : 1;
  std::vector<double> factors;
  for (std::size_t v = 0; v < scan.fdi.size(); ++v)
    factors.push_back(std::exp(share * uneven(scan.mesh.vertices[v])) * (scan.fdi[v] != 0 ? enamel : 1));
  SurfaceMesh surface = to_surface_mesh(scan.mesh);
  const std::size_t edges = surface.number_of_edges() * triangles / scan.mesh.triangles.size();
  const SMS::Count_stop_predicate<SurfaceMesh> stop(edges);
  if (random.chance(0.6))  // flat parts coarser than bent ones
    SMS::edge_collapse(surface, stop);
  else
    SMS::edge_collapse(surface, stop,
                       CGAL::parameters::get_cost(UnevenCost(std::move(factors)))
                           .get_placement(SMS::Midpoint_placement<SurfaceMesh>()));
  ScanSurface thinned;
  thinned.mesh = compact(from_surface_mesh(surface)).mesh;
  const NearestVertexIndex index(scan.mesh.vertices);
  for (const Point& p : thinned.mesh.vertices)
    thinned.fdi.push_back(scan.fdi[static_cast<std::size_t>(index.nearest(p).index)]);
  scan = std::move(thinned);
}

void tidy_labels(std::size_t least, ScanSurface& scan) {
  DisjointSets sets(scan.fdi.size());
  const auto patch = [&](std::size_t v) { return static_cast<std::size_t>(sets.find(static_cast<int>(v))); };
  const auto label = [&](std::int32_t v) { return scan.fdi[static_cast<std::size_t>(v)]; };
  for (const Triangle& t : scan.mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k)
      if (label(t[k]) == label(t[(k + 1) % 3])) sets.join(t[k], t[(k + 1) % 3]);
  std::vector<std::size_t> size(scan.fdi.size(), 0);
  for (std::size_t v = 0; v < size.size(); ++v) ++size[patch(v)];
  std::map<int, std::size_t> largest;
  for (std::size_t v = 0; v < size.size(); ++v)
    if (scan.fdi[v] != 0) largest[scan.fdi[v]] = std::max(largest[scan.fdi[v]], size[patch(v)]);
  // Around each lesser patch: how often which label.
  std::map<std::size_t, std::map<int, int>> around;
  const auto is_lesser = [&](std::size_t v) {
    const std::size_t here = size[patch(v)];
    return scan.fdi[v] == 0 ? here < 8 : here < largest[scan.fdi[v]] || here < least;
  };
  for (const Triangle& t : scan.mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k)
      for (const std::size_t other : {(k + 1) % 3, (k + 2) % 3})
        if (label(t[k]) != label(t[other]) && is_lesser(static_cast<std::size_t>(t[k])))
          ++around[patch(static_cast<std::size_t>(t[k]))][label(t[other])];
  std::vector<int> result = scan.fdi;
  for (std::size_t v = 0; v < result.size(); ++v) {
    if (!is_lesser(v)) continue;
    const auto found = around.find(patch(v));
    int best = 0, most = 0;
    if (found != around.end())
      for (const auto& [number, times] : found->second)
        if (times > most) best = number, most = times;
    result[v] = scan.fdi[v] != 0 && largest[scan.fdi[v]] < least ? 0 : best;
  }
  scan.fdi = std::move(result);
}

}  // namespace rhizodont
