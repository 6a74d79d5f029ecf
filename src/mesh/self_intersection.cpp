// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Exact self-intersection test of a triangle soup: candidate pairs from box intersection (A. Zomorodian, H.
// Edelsbrunner, "Fast software for box intersections", SoCG 2000, as in CGAL), each decided with CGAL's exact
// predicates.
#include "mesh/self_intersection.hpp"

#include "mesh/mesh_checks.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/box_intersection_d.h>
#include <CGAL/intersections.h>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>

namespace rhizodont {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point3 = Kernel::Point_3;
using Segment3 = Kernel::Segment_3;
using Triangle3 = Kernel::Triangle_3;
using Pair = std::pair<int, int>;

struct Soup {
  std::vector<Point3> points;
  const std::vector<Triangle>& triangles;

  const Point3& point(int v) const { return points[static_cast<std::size_t>(v)]; }
  std::array<Point3, 3> corners(const Triangle& t) const { return {point(t[0]), point(t[1]), point(t[2])}; }
};

bool is_degenerate(const std::array<Point3, 3>& p) { return CGAL::collinear(p[0], p[1], p[2]); }

// The longest side of a triangle without area is all of it.
Segment3 as_segment(const std::array<Point3, 3>& p) {
  Segment3 longest(p[0], p[1]);
  for (const Segment3& side : {Segment3(p[1], p[2]), Segment3(p[2], p[0])})
    if (side.squared_length() > longest.squared_length()) longest = side;
  return longest;
}

bool meets_degenerate(const std::array<Point3, 3>& flat, const std::array<Point3, 3>& other) {
  const Segment3 segment = as_segment(flat);
  if (segment.is_degenerate()) {
    const Point3& p = segment.source();
    return is_degenerate(other) ? as_segment(other).has_on(p) : Triangle3(other[0], other[1], other[2]).has_on(p);
  }
  if (!is_degenerate(other)) return CGAL::do_intersect(Triangle3(other[0], other[1], other[2]), segment);
  const Segment3 second = as_segment(other);
  return second.is_degenerate() ? segment.has_on(second.source()) : CGAL::do_intersect(segment, second);
}

// Corners of `a` that `b` has too come first, the others after them.
struct Shared {
  int count = 0;
  Triangle order{};
};

Shared shared_first(const Triangle& a, const Triangle& b) {
  Shared shared;
  shared.order = a;
  const auto middle = std::stable_partition(shared.order.begin(), shared.order.end(),
                                            [&](int v) { return std::find(b.begin(), b.end(), v) != b.end(); });
  shared.count = static_cast<int>(middle - shared.order.begin());
  return shared;
}

// Two triangles over one edge meet elsewhere only if they lie in one plane and on the same side of the edge.
bool folded_onto_each_other(const Soup& soup, const Triangle& a, const Triangle& b) {
  const Point3 &p = soup.point(a[0]), &q = soup.point(a[1]), &r = soup.point(a[2]), &s = soup.point(b[2]);
  return CGAL::coplanar(p, q, r, s) && CGAL::coplanar_orientation(p, q, r, s) == CGAL::POSITIVE;
}

// Triangles with one common corner meet elsewhere only if the side of one that is opposite to it meets the other.
bool meet_beyond_corner(const Soup& soup, const Triangle& a, const Triangle& b) {
  const Point3& common = soup.point(a[0]);
  const Point3 &a1 = soup.point(a[1]), &a2 = soup.point(a[2]), &b1 = soup.point(b[1]), &b2 = soup.point(b[2]);
  return CGAL::do_intersect(Triangle3(common, a1, a2), Segment3(b1, b2)) ||
         CGAL::do_intersect(Triangle3(common, b1, b2), Segment3(a1, a2));
}

bool triangles_meet(const Soup& soup, const Triangle& a, const Triangle& b) {
  const Shared in_a = shared_first(a, b), in_b = shared_first(b, a);
  const std::array<Point3, 3> pa = soup.corners(a), pb = soup.corners(b);
  const int shared = std::max(in_a.count, in_b.count);
  if (in_a.count == 3 && in_b.count == 3) return true;
  if (is_degenerate(pa) || is_degenerate(pb)) {
    if (shared > 0) return false;
    return is_degenerate(pa) ? meets_degenerate(pa, pb) : meets_degenerate(pb, pa);
  }
  if (shared == 2) return folded_onto_each_other(soup, in_a.order, in_b.order);
  if (shared == 1) return meet_beyond_corner(soup, in_a.order, in_b.order);
  return CGAL::do_intersect(Triangle3(pa[0], pa[1], pa[2]), Triangle3(pb[0], pb[1], pb[2]));
}

std::vector<Pair> candidate_pairs(const Soup& soup) {
  using Box = CGAL::Box_intersection_d::Box_with_info_d<double, 3, int>;
  std::vector<Box> boxes;
  boxes.reserve(soup.triangles.size());
  for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
    const auto p = soup.corners(soup.triangles[t]);
    boxes.emplace_back(p[0].bbox() + p[1].bbox() + p[2].bbox(), static_cast<int>(t));
  }
  std::vector<Pair> pairs;
  CGAL::box_self_intersection_d(boxes.begin(), boxes.end(),
                                [&](const Box& a, const Box& b) { pairs.push_back(std::minmax(a.info(), b.info())); });
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace

std::vector<Pair> self_intersecting_triangles(const TriangleMesh& mesh) {
  require_valid_indices(mesh);
  require_finite(mesh.vertices);
  Soup soup{{}, mesh.triangles};
  for (const Point& p : mesh.vertices) soup.points.emplace_back(p.x(), p.y(), p.z());
  std::vector<Pair> pairs = candidate_pairs(soup);
  std::vector<char> meet(pairs.size(), 0);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, pairs.size(), 1024), [&](const auto& range) {
    for (std::size_t k = range.begin(); k < range.end(); ++k)
      meet[k] = triangles_meet(soup, mesh.triangles[static_cast<std::size_t>(pairs[k].first)],
                               mesh.triangles[static_cast<std::size_t>(pairs[k].second)]);
  });
  std::size_t kept = 0;
  for (std::size_t k = 0; k < pairs.size(); ++k)
    if (meet[k]) pairs[kept++] = pairs[k];
  pairs.resize(kept);
  return pairs;
}

}  // namespace rhizodont
