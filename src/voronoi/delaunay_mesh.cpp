// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Y.-J. Liu, C.-X. Xu, D. Fan and Y. He, "Efficient construction and simplification of Delaunay meshes", ACM
//   Transactions on Graphics 34(6), 2015: Delaunay meshes by splitting unflippable edges.
// J. Ruppert, "A Delaunay refinement algorithm for quality 2-dimensional mesh generation", Journal of Algorithms 18,
//   1995: splitting on shells around vertices, so that edges meeting at a small angle do not split each other for ever.
//
// Why it ends. Let l be the shortest edge and theta the smallest angle, and call the piece of an edge that begins in an
// input vertex v an end piece. A piece that is not Delaunay has an apex x in the disc over it. For an end piece [v, p],
// x is either on the edge opposite to v, and |vp| > |vx| >= l sin(theta) = h, or on an edge that [v, p] meets in v,
// with a shorter end piece. Where an apex of the first kind sees a piece under more than 150 degrees, it is cut at the
// apex's foot, if need be moved to leave a tenth: at least h / 10. Whole edges and inner pieces are halved otherwise,
// and end pieces cut on shells, |vp| = u 2^k with one unit u, between 1/3 and 2/3 of their length: on shells none is
// cut shorter than the one it makes way for. So no end piece is shorter than rho_v = h / 30. The middle of an inner
// piece of length s is at least rho_v + s / 2 away from the ends of its edge and (rho_v + s / 2) sin(theta) from the
// other edges, so that it is Delaunay if s <= 2 rho_v sin(theta). No piece is shorter than rho_e = 0.2 rho_v
// sin(theta), and there are finitely many. (The paper, 3.6, has min(l sin(theta) / (0.5 + sin(theta)), l / 2) and 2
// rho_v sin(theta), for points that are all placed beforehand.)

#include "voronoi/delaunay_mesh.hpp"

#include "base/option_range.hpp"
#include "mesh/adjacency.hpp"
#include "mesh/geometry.hpp"
#include "rhizodont/error.hpp"
#include "voronoi/predicates.hpp"
#include "voronoi/restricted_voronoi.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <map>

namespace rhizodont {
namespace {

constexpr std::size_t looks_per_edge = 50;  // many times what meshes without flat triangles take

/// Cotangent of the angle at c in the triangle (a, b, c).
double cotangent(const Point& a, const Point& b, const Point& c) {
  const Eigen::Vector3d u = a - c;
  const Eigen::Vector3d v = b - c;
  const double twice_area = u.cross(v).norm();
  if (twice_area > 0) return u.dot(v) / twice_area;
  return u.dot(v) < 0 ? -std::numeric_limits<double>::infinity() : std::numeric_limits<double>::infinity();
}

/// A triangle with its neighbours and what each edge lies on.
struct Face {
  Triangle corners;
  std::array<int, 3> neighbours;  // over the edge from corner i to i + 1; -1 at a border
  std::array<int, 3> segments;    // per edge: index of the piece of an input edge, or -1 inside an input triangle
  int parent;
};

/// A piece of an input edge, with its ends also as fractions between the edge's lower and higher vertex.
struct Segment {
  std::array<int, 2> edge;
  std::array<int, 2> ends;
  double from;
  double to;
};

class DelaunayBuilder {
 public:
  DelaunayBuilder(const TriangleMesh& mesh, const DelaunayMeshOptions& options)
      : options_(options), vertices_(mesh.vertices) {
    shell_ = mean_edge_length(mesh);
    shortest_ = options.shortest_piece * shell_;
    limit_ = static_cast<std::size_t>(options.steiner_limit * static_cast<double>(mesh.vertices.size()));
    const TriangleAdjacency adjacency = triangle_adjacency(mesh);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      faces_.push_back({mesh.triangles[t], adjacency.neighbours[t], {-1, -1, -1}, static_cast<int>(t)});
    for (std::size_t t = 0; t < faces_.size(); ++t) add_segments(static_cast<int>(t));
  }

  DelaunayMesh run() {
    for (std::size_t t = 0; t < faces_.size(); ++t)
      for (int e = 0; e < 3; ++e)
        if (faces_[t].neighbours[e] > static_cast<int>(t)) queue_.push_back({corner(t, e), corner(t, e + 1)});
    // Flips end by themselves where angles are exact; rounded ones may turn flat pieces to and fro.
    std::size_t allowed = looks_per_edge * (queue_.size() + 12 * limit_);
    while (!queue_.empty() && allowed-- > 0) {
      const auto [a, b] = queue_.front();
      queue_.pop_front();
      if (hint_.size() < vertices_.size()) rebuild_hints();
      const auto found = find_edge(a, b);
      if (found.first < 0 || is_delaunay(found.first, found.second)) continue;
      repair(found.first, found.second);
    }
    return result();
  }

 private:
  int corner(std::size_t t, int i) const { return faces_[t].corners[static_cast<std::size_t>(i % 3)]; }

  void add_segments(int t) {
    for (int e = 0; e < 3; ++e) {
      if (faces_[t].segments[e] >= 0) continue;
      const int a = corner(t, e);
      const int b = corner(t, e + 1);
      const int id = static_cast<int>(segments_.size());
      const std::array<int, 2> ends{std::min(a, b), std::max(a, b)};
      segments_.push_back({ends, ends, 0, 1});
      faces_[t].segments[e] = id;
      const int n = faces_[t].neighbours[e];
      if (n < 0) continue;
      const int back = edge_towards(n, t);
      if (corner(n, back) != b) throw InputError("Two neighbouring triangles are turned against each other.", {t, n});
      faces_[n].segments[back] = id;
    }
  }

  int edge_towards(int t, int neighbour) const {
    for (int e = 0; e < 3; ++e)
      if (faces_[t].neighbours[e] == neighbour) return e;
    return -1;
  }

  void rebuild_hints() {
    hint_.assign(vertices_.size(), -1);
    for (std::size_t t = 0; t < faces_.size(); ++t)
      for (const int v : faces_[t].corners) hint_[static_cast<std::size_t>(v)] = static_cast<int>(t);
  }

  int index_in(int t, int v) const {
    for (int i = 0; i < 3; ++i)
      if (faces_[t].corners[i] == v) return i;
    return -1;
  }

  /// Triangle and edge number of the interior edge from a to b; {-1, -1} if there is none.
  std::pair<int, int> find_edge(int a, int b) const {
    for (const bool forward : {true, false}) {
      int t = hint_[static_cast<std::size_t>(a)];
      const int start = t;
      while (t >= 0) {
        const int i = index_in(t, a);
        if (corner(t, i + 1) == b) return faces_[t].neighbours[i] >= 0 ? std::pair{t, i} : std::pair{-1, -1};
        if (corner(t, i + 2) == b) {
          const int n = faces_[t].neighbours[(i + 2) % 3];
          return n >= 0 ? std::pair{t, (i + 2) % 3} : std::pair{-1, -1};
        }
        t = forward ? faces_[t].neighbours[(i + 2) % 3] : faces_[t].neighbours[i];
        if (t == start) break;
      }
      if (t == start) break;
    }
    return {-1, -1};
  }

  double cotangent_opposite(int t, int e) const {
    return cotangent(vertices_[corner(t, e)], vertices_[corner(t, e + 1)], vertices_[corner(t, e + 2)]);
  }

  bool is_delaunay(int t, int e) const {
    const int n = faces_[t].neighbours[e];
    const double sum = cotangent_opposite(t, e) + cotangent_opposite(n, edge_towards(n, t));
    return sum >= -options_.angle_slack;
  }

  void repair(int t, int e) {
    const int n = faces_[t].neighbours[e];
    if (faces_[t].segments[e] < 0 && faces_[t].parent == faces_[n].parent)
      flip(t, e);
    else
      split(t, e);
  }

  void set_neighbour(int t, int old_neighbour, int new_neighbour) {
    if (t >= 0) faces_[t].neighbours[edge_towards(t, old_neighbour)] = new_neighbour;
  }

  void enqueue(int t, int e) { queue_.push_back({corner(t, e), corner(t, e + 1)}); }

  void flip(int t, int e) {
    const int n = faces_[t].neighbours[e];
    const int f = edge_towards(n, t);
    const int a = corner(t, e), b = corner(t, e + 1), c = corner(t, e + 2), d = corner(n, f + 2);
    const Face old_t = faces_[t], old_n = faces_[n];
    const int e1 = (e + 1) % 3, e2 = (e + 2) % 3, f1 = (f + 1) % 3, f2 = (f + 2) % 3;
    // t becomes (c, a, d), n becomes (d, b, c).
    faces_[t] = {{c, a, d},
                 {old_t.neighbours[e2], old_n.neighbours[f1], n},
                 {old_t.segments[e2], old_n.segments[f1], -1},
                 old_t.parent};
    faces_[n] = {{d, b, c},
                 {old_n.neighbours[f2], old_t.neighbours[e1], t},
                 {old_n.segments[f2], old_t.segments[e1], -1},
                 old_t.parent};
    set_neighbour(old_n.neighbours[f1], n, t);
    set_neighbour(old_t.neighbours[e1], t, n);
    for (const int v : {a, c, d}) hint_[static_cast<std::size_t>(v)] = t;
    hint_[static_cast<std::size_t>(b)] = n;
    for (int i = 0; i < 2; ++i) {
      enqueue(t, i);
      enqueue(n, i);
    }
  }

  /// Whether a Steiner point lies on an edge that meets the one of `segment` in the end where the segment begins.
  bool shares_end(const Segment& segment, int apex) const {
    const int steiner = apex - (static_cast<int>(vertices_.size()) - static_cast<int>(steiner_edges_.size()));
    if (steiner < 0) return false;
    const int end = segment.edge[segment.from == 0 ? 0 : 1];
    const std::array<int, 2>& other = steiner_edges_[static_cast<std::size_t>(steiner)];
    return other[0] == end || other[1] == end;
  }

  /// Fraction, on the input edge, at which to split a segment for the apex that sees it under the larger angle, with
  /// that cotangent and with its foot at `foot`.
  double split_position(const Segment& segment, int apex, double larger_cotangent, double foot) const {
    constexpr double cotangent_of_150_degrees = -1.7320508;
    const double length = segment.to - segment.from;
    const bool starts = segment.from == 0;
    const bool is_end_piece = starts != (segment.to == 1);
    if (larger_cotangent < cotangent_of_150_degrees && !(is_end_piece && shares_end(segment, apex)))
      return std::clamp(foot, segment.from + 0.1 * length, segment.to - 0.1 * length);
    if (!is_end_piece) return 0.5 * (segment.from + segment.to);
    // The largest shell that leaves a third of the piece.
    const double whole = (vertices_[segment.edge[1]] - vertices_[segment.edge[0]]).norm();
    const double shell = shell_ * std::exp2(std::floor(std::log2(2.0 / 3 * length * whole / shell_))) / whole;
    return starts ? shell : 1 - shell;
  }

  void split(int t, int e) {
    const int n = faces_[t].neighbours[e];
    const int f = edge_towards(n, t);
    const int a = corner(t, e), b = corner(t, e + 1), c = corner(t, e + 2), d = corner(n, f + 2);
    const double length = (vertices_[b] - vertices_[a]).norm();
    if (steiner_edges_.size() >= limit_ || length < 2 * shortest_) return;
    const int s = faces_[t].segments[e];
    const Segment whole = segments_[s];
    const bool forward = a == whole.ends[0];
    const double cotangent_c = cotangent_opposite(t, e);
    const double cotangent_d = cotangent_opposite(n, f);
    const int apex = cotangent_c < cotangent_d ? c : d;
    const double along =
        std::clamp((vertices_[apex] - vertices_[a]).dot(vertices_[b] - vertices_[a]) / (length * length), 0.0, 1.0);
    const double foot = whole.from + (forward ? along : 1 - along) * (whole.to - whole.from);
    const double at = split_position(whole, apex, std::min(cotangent_c, cotangent_d), foot);
    const int p = add_steiner(whole.edge, at);
    // Two pieces: `s` keeps the one at `from`.
    segments_[s].to = at;
    segments_[s].ends[1] = p;
    const int s2 = static_cast<int>(segments_.size());
    segments_.push_back({whole.edge, {p, whole.ends[1]}, at, whole.to});
    const int piece_a = forward ? s : s2;
    const int piece_b = forward ? s2 : s;

    const Face old_t = faces_[t], old_n = faces_[n];
    const int e1 = (e + 1) % 3, e2 = (e + 2) % 3, f1 = (f + 1) % 3, f2 = (f + 2) % 3;
    const int t2 = static_cast<int>(faces_.size());
    const int n2 = t2 + 1;
    // t: (a, p, c), t2: (p, b, c), n: (p, a, d), n2: (b, p, d).
    faces_[t] = {{a, p, c}, {n, t2, old_t.neighbours[e2]}, {piece_a, -1, old_t.segments[e2]}, old_t.parent};
    faces_.push_back({{p, b, c}, {n2, old_t.neighbours[e1], t}, {piece_b, old_t.segments[e1], -1}, old_t.parent});
    faces_[n] = {{p, a, d}, {t, old_n.neighbours[f1], n2}, {piece_a, old_n.segments[f1], -1}, old_n.parent};
    faces_.push_back({{b, p, d}, {t2, n, old_n.neighbours[f2]}, {piece_b, -1, old_n.segments[f2]}, old_n.parent});
    set_neighbour(old_t.neighbours[e1], t, t2);
    set_neighbour(old_n.neighbours[f2], n, n2);
    hint_[static_cast<std::size_t>(a)] = t;
    hint_[static_cast<std::size_t>(b)] = t2;
    hint_[static_cast<std::size_t>(c)] = t;
    hint_[static_cast<std::size_t>(d)] = n;
    hint_.push_back(t);
    for (const int face : {t, t2, n, n2})
      for (int i = 0; i < 3; ++i) enqueue(face, i);
  }

  Point point_on(const std::array<int, 2>& edge, double fraction) const {
    return (1 - fraction) * vertices_[edge[0]] + fraction * vertices_[edge[1]];
  }

  int add_steiner(const std::array<int, 2>& edge, double fraction) {
    vertices_.push_back(point_on(edge, fraction));
    steiner_edges_.push_back(edge);
    return static_cast<int>(vertices_.size()) - 1;
  }

  DelaunayMesh result() {
    DelaunayMesh out;
    for (std::size_t t = 0; t < faces_.size(); ++t)
      for (int e = 0; e < 3; ++e)
        if (faces_[t].neighbours[e] > static_cast<int>(t) && !is_delaunay(static_cast<int>(t), e)) ++out.edges_left;
    out.mesh.vertices = std::move(vertices_);
    for (const Face& face : faces_) {
      out.mesh.triangles.push_back(face.corners);
      out.parent_triangle.push_back(face.parent);
    }
    out.steiner_edges = std::move(steiner_edges_);
    return out;
  }

  DelaunayMeshOptions options_;
  std::vector<Point> vertices_;
  std::vector<Face> faces_;
  std::vector<Segment> segments_;
  std::vector<std::array<int, 2>> steiner_edges_;
  std::deque<std::array<int, 2>> queue_;
  std::vector<int> hint_;  // per vertex: a triangle that has it
  double shell_ = 0;       // unit of the shells' radii
  double shortest_ = 0;
  std::size_t limit_ = 0;
};

}  // namespace

std::vector<std::array<int, 2>> non_delaunay_edges(const TriangleMesh& mesh, double angle_slack) {
  const TriangleAdjacency adjacency = triangle_adjacency(mesh);
  std::vector<std::array<int, 2>> found;
  const auto apex = [&](std::size_t t, int a, int b) {
    const Triangle& triangle = mesh.triangles[t];
    return *std::find_if(triangle.begin(), triangle.end(), [&](int c) { return c != a && c != b; });
  };
  const auto is_delaunay = [&](const Point& a, const Point& b, const Point& c, const Point& d) {
    if (angle_slack == 0) return delaunay_sign(a, b, c, d) >= 0;
    return cotangent(a, b, c) + cotangent(a, b, d) >= -angle_slack;
  };
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t e = 0; e < 3; ++e) {
      const int n = adjacency.neighbours[t][e];
      if (n < static_cast<int>(t)) continue;
      const int a = mesh.triangles[t][e];
      const int b = mesh.triangles[t][(e + 1) % 3];
      if (!is_delaunay(mesh.vertices[a], mesh.vertices[b], mesh.vertices[apex(t, a, b)],
                       mesh.vertices[apex(static_cast<std::size_t>(n), a, b)]))
        found.push_back({std::min(a, b), std::max(a, b)});
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

void require_in_range(const DelaunayMeshOptions& options) {
  require_ranges("a Delaunay mesh", {{"angle_slack", options.angle_slack, OptionRange::at_least(0)},
                                     {"shortest_piece", options.shortest_piece, OptionRange::at_least(0)},
                                     {"steiner_limit", options.steiner_limit, OptionRange::at_least(0)}});
}

DelaunayMesh make_delaunay_mesh(const TriangleMesh& mesh, const DelaunayMeshOptions& options) {
  require_in_range(options);
  return DelaunayBuilder(mesh, options).run();
}

SteinerBounds steiner_bounds(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) throw InputError("A mesh without triangles has no edges to put points on.");
  SteinerBounds bounds;
  bounds.shortest_edge = std::numeric_limits<double>::infinity();
  bounds.smallest_angle = std::numeric_limits<double>::infinity();
  double length = 0;  // interior edges are met from both sides
  const TriangleAdjacency adjacency = triangle_adjacency(mesh);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const double angle : triangle_angles(mesh, t)) bounds.smallest_angle = std::min(bounds.smallest_angle, angle);
    for (std::size_t e = 0; e < 3; ++e) {
      const Triangle& triangle = mesh.triangles[t];
      const double edge = (mesh.vertices[triangle[(e + 1) % 3]] - mesh.vertices[triangle[e]]).norm();
      bounds.shortest_edge = std::min(bounds.shortest_edge, edge);
      if (adjacency.neighbours[t][e] >= 0) length += edge / 2;
    }
  }
  const double sine = std::sin(bounds.smallest_angle);
  bounds.end_gap = bounds.shortest_edge * sine / 30;
  bounds.inner_gap = 0.2 * bounds.end_gap * sine;
  bounds.most_points = length / bounds.inner_gap;
  return bounds;
}

namespace {

/// The directed edges that only one of the triangles has, sorted; nothing if an edge is there twice.
std::vector<std::array<int, 2>> outline(const std::vector<Triangle>& triangles) {
  std::vector<std::array<int, 2>> edges;
  for (const Triangle& t : triangles)
    for (std::size_t i = 0; i < 3; ++i) edges.push_back({t[i], t[(i + 1) % 3]});
  std::sort(edges.begin(), edges.end());
  if (std::adjacent_find(edges.begin(), edges.end()) != edges.end()) return {};
  std::vector<std::array<int, 2>> single;
  for (const auto& [a, b] : edges)
    if (!std::binary_search(edges.begin(), edges.end(), std::array{b, a})) single.push_back({a, b});
  return single;
}

/// What is known of an input triangle that the dual does not give piece by piece.
struct Doubtful {
  std::vector<Triangle> pieces;
  std::vector<Triangle> in_dual;  // triangles of the dual between its sites
};

}  // namespace

std::vector<bool> triangles_given_by_dual(const TriangleMesh& input, const DelaunayMesh& delaunay,
                                          const std::vector<Triangle>& dual) {
  std::vector<bool> given(input.triangles.size(), true);
  const std::vector<Triangle>& pieces = delaunay.mesh.triangles;
  const auto parent = [&](std::size_t piece) { return static_cast<std::size_t>(delaunay.parent_triangle[piece]); };
  for (std::size_t i = 0; i < pieces.size(); ++i)
    if (!std::binary_search(dual.begin(), dual.end(), lowest_first(pieces[i]))) given[parent(i)] = false;

  std::map<std::size_t, Doubtful> doubtful;
  std::vector<std::vector<std::size_t>> around(delaunay.mesh.vertices.size());  // doubtful triangles by site
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (given[parent(i)]) continue;
    doubtful[parent(i)].pieces.push_back(pieces[i]);
    for (const int v : pieces[i]) {
      std::vector<std::size_t>& list = around[static_cast<std::size_t>(v)];
      if (std::find(list.begin(), list.end(), parent(i)) == list.end()) list.push_back(parent(i));
    }
  }
  for (const Triangle& t : dual) {
    const auto has = [&](int v, std::size_t triangle) {
      const std::vector<std::size_t>& list = around[static_cast<std::size_t>(v)];
      return std::find(list.begin(), list.end(), triangle) != list.end();
    };
    if (*std::max_element(t.begin(), t.end()) >= static_cast<int>(around.size())) continue;
    for (const std::size_t triangle : around[static_cast<std::size_t>(t[0])])
      if (has(t[1], triangle) && has(t[2], triangle)) doubtful[triangle].in_dual.push_back(t);
  }
  // As many triangles with the same outline over the same sites: another triangulation of the same polygon.
  for (const auto& [triangle, found] : doubtful)
    given[triangle] = found.in_dual.size() == found.pieces.size() && outline(found.in_dual) == outline(found.pieces);
  return given;
}

StrongDelaunay test_strong_delaunay(const TriangleMesh& mesh) {
  const RestrictedVoronoi voronoi = restricted_voronoi(mesh.vertices, mesh);
  std::vector<Triangle> dual = voronoi.triangles;
  dual.erase(std::unique(dual.begin(), dual.end()), dual.end());
  StrongDelaunay result;
  std::size_t found = 0;
  for (const Triangle& t : mesh.triangles) {
    const bool in_dual = std::binary_search(dual.begin(), dual.end(), lowest_first(t));
    result.triangle_in_dual.push_back(in_dual);
    if (in_dual)
      ++found;
    else
      ++result.missing;
  }
  result.additional = static_cast<int>(dual.size() - found);
  return result;
}

}  // namespace rhizodont
