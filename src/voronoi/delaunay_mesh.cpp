// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Y.-J. Liu, C.-X. Xu, D. Fan and Y. He, "Efficient construction and simplification of Delaunay meshes", ACM
// Transactions
//   on Graphics 34(6), 2015: Delaunay meshes by splitting unflippable edges.
// J. Ruppert, "A Delaunay refinement algorithm for quality 2-dimensional mesh generation", Journal of Algorithms 18,
// 1995:
//   splitting at power-of-two fractions, so that edges meeting at a small angle do not split each other for ever.

#include "voronoi/delaunay_mesh.hpp"

#include "mesh/adjacency.hpp"
#include "mesh/geometry.hpp"
#include "rhizodont/error.hpp"
#include "voronoi/restricted_voronoi.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>

namespace rhizodont {
namespace {

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

/// A piece of an input edge, by its ends as fractions between the edge's lower and higher vertex.
struct Segment {
  std::array<int, 2> edge;
  double from;
  double to;
};

class DelaunayBuilder {
 public:
  DelaunayBuilder(const TriangleMesh& mesh, const DelaunayMeshOptions& options)
      : options_(options), vertices_(mesh.vertices) {
    shortest_ = options.shortest_piece * mean_edge_length(mesh);
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
    while (!queue_.empty()) {
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
      segments_.push_back({{std::min(a, b), std::max(a, b)}, 0, 1});
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

  /// Fraction, on the input edge, at which to split a segment whose foot of the apex is at `foot`.
  static double dyadic_split(double from, double to, double foot) {
    const double length = to - from;
    const double wanted = std::clamp(foot, from + 0.3 * length, to - 0.3 * length);
    const double step = std::exp2(std::floor(std::log2(length / 4)));
    const double snapped = std::round(wanted / step) * step;
    return snapped > from && snapped < to ? snapped : 0.5 * (from + to);
  }

  void split(int t, int e) {
    const int n = faces_[t].neighbours[e];
    const int f = edge_towards(n, t);
    const int a = corner(t, e), b = corner(t, e + 1), c = corner(t, e + 2), d = corner(n, f + 2);
    const double length = (vertices_[b] - vertices_[a]).norm();
    if (steiner_edges_.size() >= limit_ || length < 2 * shortest_) {
      ++edges_left_;
      return;
    }
    const int s = faces_[t].segments[e];
    const Segment whole = segments_[s];
    const bool forward = faces_[t].corners[e] == lower_end(whole, a, b);
    const int apex = cotangent_opposite(t, e) < cotangent_opposite(n, f) ? c : d;
    const double along =
        std::clamp((vertices_[apex] - vertices_[a]).dot(vertices_[b] - vertices_[a]) / (length * length), 0.0, 1.0);
    const double foot = whole.from + (forward ? along : 1 - along) * (whole.to - whole.from);
    const double at = dyadic_split(whole.from, whole.to, foot);
    const int p = add_steiner(whole.edge, at);
    // Two pieces: `s` keeps the one at `from`.
    segments_[s].to = at;
    const int s2 = static_cast<int>(segments_.size());
    segments_.push_back({whole.edge, at, whole.to});
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

  /// Which of a, b is nearer to the start of the segment; pieces know their ends by fraction only.
  int lower_end(const Segment& segment, int a, int b) const {
    const Point start = point_on(segment.edge, segment.from);
    return (vertices_[a] - start).squaredNorm() <= (vertices_[b] - start).squaredNorm() ? a : b;
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
    out.mesh.vertices = std::move(vertices_);
    for (const Face& face : faces_) {
      out.mesh.triangles.push_back(face.corners);
      out.parent_triangle.push_back(face.parent);
    }
    out.steiner_edges = std::move(steiner_edges_);
    out.edges_left = edges_left_;
    return out;
  }

  DelaunayMeshOptions options_;
  std::vector<Point> vertices_;
  std::vector<Face> faces_;
  std::vector<Segment> segments_;
  std::vector<std::array<int, 2>> steiner_edges_;
  std::deque<std::array<int, 2>> queue_;
  std::vector<int> hint_;  // per vertex: a triangle that has it
  double shortest_ = 0;
  std::size_t limit_ = 0;
  int edges_left_ = 0;
};

}  // namespace

std::vector<std::array<int, 2>> non_delaunay_edges(const TriangleMesh& mesh, double angle_slack) {
  const TriangleAdjacency adjacency = triangle_adjacency(mesh);
  std::vector<std::array<int, 2>> found;
  const auto opposite = [&](std::size_t t, int a, int b) {
    for (const int c : mesh.triangles[t])
      if (c != a && c != b) return cotangent(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]);
    return -std::numeric_limits<double>::infinity();
  };
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t e = 0; e < 3; ++e) {
      const int n = adjacency.neighbours[t][e];
      if (n < static_cast<int>(t)) continue;
      const int a = mesh.triangles[t][e];
      const int b = mesh.triangles[t][(e + 1) % 3];
      if (!(opposite(t, a, b) + opposite(static_cast<std::size_t>(n), a, b) >= -angle_slack))
        found.push_back({std::min(a, b), std::max(a, b)});
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

DelaunayMesh make_delaunay_mesh(const TriangleMesh& mesh, const DelaunayMeshOptions& options) {
  return DelaunayBuilder(mesh, options).run();
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
