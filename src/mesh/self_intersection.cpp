// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Exact self-intersection test of a triangle soup: candidate pairs are those whose boxes meet, each decided with CGAL's
// exact predicates.
#include "mesh/self_intersection.hpp"

#include "mesh/at.hpp"
#include "mesh/box_tree.hpp"
#include "mesh/mesh_checks.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/intersections.h>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

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
  const std::vector<Point>& coordinates;  // of the same points

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

/// Which side of the line from p to q the point r is on, seen along an axis: 1 or -1 where rounding cannot change it,
/// else 0. Bound of the error: J. R. Shewchuk, "Adaptive precision floating-point arithmetic and fast robust geometric
/// predicates", 1997.
inline int sure_side(const Point& p, const Point& q, const Point& r, int first, int second) {
  constexpr double relative = 4e-16, underflow = 1e-290;
  const double left = (q[first] - p[first]) * (r[second] - p[second]);
  const double right = (q[second] - p[second]) * (r[first] - p[first]);
  const double sure = relative * (std::abs(left) + std::abs(right)) + underflow;
  return left - right > sure ? 1 : left - right < -sure ? -1 : 0;
}

/// Whether, seen along an axis, a line along a side of `a` has `a` on one side and `b` on the other, but for corners of
/// the side that both have: then they meet nowhere else. Spares most pairs the exact test, which takes long where
/// triangles lie in one plane.
bool is_apart_along_a_side(const Soup& soup, const Triangle& a, const Triangle& b) {
  const auto at = [&](int v) -> const Point& { return soup.coordinates[static_cast<std::size_t>(v)]; };
  for (int axis = 0; axis < 3; ++axis)
    for (std::size_t i = 0; i < 3; ++i) {
      const int from = a[i], to = a[(i + 1) % 3];
      const auto side = [&](int v) { return sure_side(at(from), at(to), at(v), axis, (axis + 1) % 3); };
      const int own = side(a[(i + 2) % 3]);
      if (own != 0 && std::all_of(b.begin(), b.end(), [&](int v) { return v == from || v == to || side(v) == -own; }))
        return true;
    }
  return false;
}

/// Triangles by the vertex that very many of them have in common, as the fan of a large polygon has; `hubs` are those
/// vertices, `at_hub` the triangles of each, `others` all the rest.
struct Crowds {
  std::vector<int> hubs;
  std::vector<std::vector<int>> at_hub;
  std::vector<int> others;
};

Crowds find_crowds(const Soup& soup) {
  constexpr std::size_t few = 512, most_hubs = 64;
  const std::size_t many = std::max(few, soup.triangles.size() / most_hubs);
  std::vector<std::size_t> degree(soup.points.size(), 0);
  for (const Triangle& t : soup.triangles)
    for (const int v : t) ++degree[static_cast<std::size_t>(v)];
  std::vector<int> number(soup.points.size(), -1);
  Crowds crowds;
  for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
    const Triangle& c = soup.triangles[t];
    const int hub = *std::max_element(c.begin(), c.end(), [&](int a, int b) {
      return degree[static_cast<std::size_t>(a)] < degree[static_cast<std::size_t>(b)];
    });
    if (degree[static_cast<std::size_t>(hub)] <= many) {
      crowds.others.push_back(static_cast<int>(t));
      continue;
    }
    int& n = number[static_cast<std::size_t>(hub)];
    if (n < 0) {
      n = static_cast<int>(crowds.hubs.size());
      crowds.hubs.push_back(hub);
      crowds.at_hub.emplace_back();
    }
    crowds.at_hub[static_cast<std::size_t>(n)].push_back(static_cast<int>(t));
  }
  return crowds;
}

std::vector<ClosedBox> boxes_of(const Soup& soup, const std::vector<int>& triangles) {
  std::vector<ClosedBox> boxes(triangles.size());
  for (std::size_t k = 0; k < triangles.size(); ++k) {
    const Triangle& t = soup.triangles[static_cast<std::size_t>(triangles[k])];
    const Point3 &a = soup.point(t[0]), &b = soup.point(t[1]), &c = soup.point(t[2]);
    for (int axis = 0; axis < 3; ++axis) {
      const auto i = static_cast<std::size_t>(axis);
      boxes[k].low[i] = std::min({a[axis], b[axis], c[axis]});
      boxes[k].high[i] = std::max({a[axis], b[axis], c[axis]});
    }
  }
  return boxes;
}

/// Around the directions in which a triangle lies as seen from one of its corners: the arc between two points of the
/// unit sphere. Triangles that meet anywhere but at that corner lie in a common direction.
ClosedBox box_of_directions(const Soup& soup, int triangle, int corner) {
  constexpr double rounding = 1e-12;
  std::array<Eigen::Vector3d, 2> ends{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  std::size_t count = 0;
  const Point3& from = soup.point(corner);
  for (const int v : soup.triangles[static_cast<std::size_t>(triangle)]) {
    if (v == corner || count == 2) continue;
    const Point3& to = soup.point(v);
    ends[count++] = Eigen::Vector3d(to.x() - from.x(), to.y() - from.y(), to.z() - from.z()).stableNormalized();
  }
  const double bulge = 1 - 0.5 * (ends[0] + ends[1]).norm() + rounding;  // of the arc beyond its chord
  const Eigen::Vector3d low = ends[0].cwiseMin(ends[1]).array() - bulge,
                        high = ends[0].cwiseMax(ends[1]).array() + bulge;
  return {{low.x(), low.y(), low.z()}, {high.x(), high.y(), high.z()}};
}

/// Those of the triangles whose boxes meet the box around all others.
std::vector<int> near_the_others(const Soup& soup, const std::vector<int>& triangles, const std::vector<int>& others) {
  std::vector<int> near;
  if (triangles.empty() || others.empty()) return near;
  const std::vector<ClosedBox> boxes = boxes_of(soup, others);
  ClosedBox around = boxes.front();
  for (const ClosedBox& box : boxes) around.extend(box);
  const std::vector<ClosedBox> own = boxes_of(soup, triangles);
  for (std::size_t k = 0; k < triangles.size(); ++k)
    if (own[k].meets(around)) near.push_back(triangles[k]);
  return near;
}

/// Pairs that may meet: their boxes do, and where they have a hub in common, the directions in which they lie from it;
/// and no side of one keeps them apart. None of two among the first `clear` triangles.
std::vector<Pair> candidate_pairs(const Soup& soup, std::size_t clear) {
  std::vector<Pair> pairs;
  // `found`: pairs by their places in lists of triangles.
  const auto note = [&](const std::vector<Pair>& found, const std::vector<int>& first, const std::vector<int>& second) {
    for (const auto& [i, j] : found)
      pairs.push_back(std::minmax(first[static_cast<std::size_t>(i)], second[static_cast<std::size_t>(j)]));
  };
  const auto may_meet = [&](const std::vector<int>& first, const std::vector<int>& second) {
    return [&](int i, int j) {
      const auto a = static_cast<std::size_t>(first[static_cast<std::size_t>(i)]),
                 b = static_cast<std::size_t>(second[static_cast<std::size_t>(j)]);
      if (a < clear && b < clear) return false;
      const Triangle &s = soup.triangles[a], &t = soup.triangles[b];
      return !is_apart_along_a_side(soup, s, t) && !is_apart_along_a_side(soup, t, s);
    };
  };
  const Crowds crowds = find_crowds(soup);
  std::vector<int> done = crowds.others;  // ascending
  const auto first_new = std::ranges::partition_point(done, [&](int t) { return static_cast<std::size_t>(t) < clear; });
  const std::vector<int> fresh(first_new, done.end());
  const BoxTree tree(boxes_of(soup, fresh));
  note(tree.meeting_pairs(may_meet(fresh, fresh)), fresh, fresh);
  const std::vector<int> near = near_the_others(soup, {done.begin(), first_new}, fresh);
  note(tree.meeting_pairs(BoxTree(boxes_of(soup, near)), may_meet(fresh, near)), fresh, near);
  for (std::size_t k = 0; k < crowds.hubs.size(); ++k) {
    const std::vector<int>& crowd = crowds.at_hub[k];
    note(BoxTree(boxes_of(soup, crowd)).meeting_pairs(BoxTree(boxes_of(soup, done)), may_meet(crowd, done)), crowd,
         done);
    done.insert(done.end(), crowd.begin(), crowd.end());
    std::vector<ClosedBox> directions;
    directions.reserve(crowd.size());
    for (const int t : crowd) directions.push_back(box_of_directions(soup, t, crowds.hubs[k]));
    note(BoxTree(directions).meeting_pairs(may_meet(crowd, crowd)), crowd, crowd);
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

Soup soup_of(const std::vector<Point>& vertices, const std::vector<Triangle>& triangles) {
  Soup soup{{}, triangles, vertices};
  soup.points.reserve(vertices.size());
  for (const Point& p : vertices) soup.points.emplace_back(p.x(), p.y(), p.z());
  return soup;
}

std::vector<Pair> those_that_meet(const Soup& soup, std::vector<Pair> pairs) {
  std::vector<char> meet(pairs.size(), 0);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, pairs.size(), 1024), [&](const auto& range) {
    for (std::size_t k = range.begin(); k < range.end(); ++k)
      meet[k] = triangles_meet(soup, soup.triangles[at(pairs[k].first)], soup.triangles[at(pairs[k].second)]);
  });
  std::size_t kept = 0;
  for (std::size_t k = 0; k < pairs.size(); ++k)
    if (meet[k]) pairs[kept++] = pairs[k];
  pairs.resize(kept);
  return pairs;
}

}  // namespace

std::vector<Pair> self_intersecting_triangles(const TriangleMesh& mesh, std::size_t first_clear) {
  require_valid_indices(mesh);
  require_finite(mesh.vertices);
  const Soup soup = soup_of(mesh.vertices, mesh.triangles);
  return those_that_meet(soup, candidate_pairs(soup, first_clear));
}

std::vector<bool> meeting_mesh(const TriangleMesh& mesh, const std::vector<Triangle>& others) {
  TriangleMesh all = mesh;
  all.triangles.insert(all.triangles.end(), others.begin(), others.end());
  require_valid_indices(all);
  require_finite(all.vertices);
  const Soup soup = soup_of(all.vertices, all.triangles);
  std::vector<int> of_mesh(mesh.triangles.size()), of_others(others.size());
  std::iota(of_mesh.begin(), of_mesh.end(), 0);
  std::iota(of_others.begin(), of_others.end(), static_cast<int>(mesh.triangles.size()));
  const std::vector<int> near = near_the_others(soup, of_mesh, of_others);
  const BoxTree tree(boxes_of(soup, of_others));
  std::vector<Pair> pairs;
  for (const auto& [i, j] : tree.meeting_pairs(BoxTree(boxes_of(soup, near)), [&](int i, int j) {
         const Triangle &s = soup.triangles[at(of_others[at(i)])], &t = soup.triangles[at(near[at(j)])];
         return !is_apart_along_a_side(soup, s, t) && !is_apart_along_a_side(soup, t, s);
       }))
    pairs.emplace_back(near[at(j)], of_others[at(i)]);
  std::vector<bool> meeting(others.size(), false);
  for (const Pair& pair : those_that_meet(soup, std::move(pairs)))
    meeting[at(pair.second) - mesh.triangles.size()] = true;
  return meeting;
}

}  // namespace rhizodont
