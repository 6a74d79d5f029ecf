// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// The search for the triangulation of a polygon in space that bends least: G. Barequet and M. Sharir, "Filling gaps in
// the boundary of a polyhedron", 1995, with the weights of P. Liepa, "Filling holes in meshes", 2003. Here triangles
// that meet the mesh are left out as they turn up.

#include "fusion/clear_filling.hpp"

#include "mesh/at.hpp"
#include "mesh/self_intersection.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <set>
#include <utility>

namespace rhizodont {
namespace {

constexpr std::size_t most_vertices = 250;
/// Up to so many vertices all triangles are tested beforehand.
constexpr std::size_t few_vertices = 48;
/// Rounds are as many as cost about so many triangles looked at.
constexpr double most_effort = 1.5e7;
constexpr std::size_t most_rounds = 60;
/// Altitude of a triangle over its longest side, below which it is not taken.
constexpr double thinnest = 1e-4;

struct Weight {
  double bend = std::numeric_limits<double>::infinity();  // 0 (flat) to 2 (folded back): 1 - cosine
  double area = 0;                                        // mm^2

  bool is_possible() const { return bend < 3; }
  bool operator<(const Weight& other) const { return bend < other.bend || (bend == other.bend && area < other.area); }
};

/// A hole's border as a polygon; triangles are named by places along it.
class Polygon {
 public:
  Polygon(const TriangleMesh& mesh, const std::vector<int>& hole) : hole_(hole) {
    points_.reserve(hole.size());
    for (const int v : hole) points_.push_back(mesh.vertices[at(v)]);
    std::vector<int> place(mesh.vertices.size(), -1);
    for (std::size_t i = 0; i < hole.size(); ++i) place[at(hole[i])] = static_cast<int>(i);
    beside_.resize(hole.size(), Eigen::Vector3d::Zero());
    allowed_.assign(hole.size() * hole.size(), 1);
    for (const Triangle& t : mesh.triangles)
      for (std::size_t k = 0; k < 3; ++k) {
        const int a = place[at(t[k])], b = place[at(t[(k + 1) % 3])];
        if (a < 0 || b < 0) continue;
        forbid(at(a), at(b));  // sides of the polygon are never asked about
        if (at(a) == (at(b) + 1) % size())
          beside_[at(b)] = normal(mesh.vertices[at(t[0])], mesh.vertices[at(t[1])], mesh.vertices[at(t[2])]);
      }
    forbid_chords_that_meet(mesh);
  }

  std::size_t size() const { return points_.size(); }
  Triangle triangle(std::size_t i, std::size_t m, std::size_t k) const { return {hole_[i], hole_[m], hole_[k]}; }
  const Eigen::Vector3d& beside(std::size_t side) const { return beside_[side]; }  // from `side` to the next vertex
  Eigen::Vector3d normal_of(std::size_t i, std::size_t m, std::size_t k) const {
    return normal(points_[i], points_[m], points_[k]);
  }
  double area_of(std::size_t i, std::size_t m, std::size_t k) const {
    return 0.5 * (points_[m] - points_[i]).cross(points_[k] - points_[i]).norm();
  }
  bool is_side(std::size_t i, std::size_t k) const { return k == i + 1 || (i == 0 && k + 1 == size()); }
  bool allows(std::size_t i, std::size_t k) const { return is_side(i, k) || allowed_[i * size() + k] != 0; }

 private:
  static Eigen::Vector3d normal(const Point& a, const Point& b, const Point& c) {
    const Eigen::Vector3d u = b - a, v = c - a, n = u.cross(v);
    const double longest = std::max({u.squaredNorm(), v.squaredNorm(), (c - b).squaredNorm()}), length = n.norm();
    if (!(length > thinnest * longest)) return Eigen::Vector3d::Zero();
    return n / length;
  }

  void forbid(std::size_t i, std::size_t k) { allowed_[i * size() + k] = allowed_[k * size() + i] = 0; }

  void forbid_chords_that_meet(const TriangleMesh& mesh) {
    std::vector<Triangle> chords;
    std::vector<std::pair<std::size_t, std::size_t>> ends;
    for (std::size_t i = 0; i < size(); ++i)
      for (std::size_t k = i + 2; k < size(); ++k) {
        if (is_side(i, k) || !allows(i, k)) continue;
        ends.emplace_back(i, k);
        chords.push_back({hole_[i], hole_[k], hole_[k]});
      }
    const std::vector<bool> meet = meeting_mesh(mesh, chords);
    for (std::size_t c = 0; c < chords.size(); ++c)
      if (meet[c]) forbid(ends[c].first, ends[c].second);
  }

  const std::vector<int>& hole_;
  std::vector<Point> points_;
  std::vector<Eigen::Vector3d> beside_;  // normal of the mesh's triangle at each side
  std::vector<char> allowed_;            // chords, both ways
};

using Places = std::array<std::size_t, 3>;

/// The triangulation of least weight without the `forbidden` triangles; nothing if there is none.
std::optional<std::vector<Places>> least_bent(const Polygon& polygon, const std::set<Places>& forbidden) {
  const std::size_t n = polygon.size();
  std::vector<Weight> best(n * n);
  std::vector<std::size_t> apex(n * n, 0);
  std::vector<Eigen::Vector3d> normals(n * n, Eigen::Vector3d::Zero());  // of the triangle over a chord, or at a side
  for (std::size_t i = 0; i + 1 < n; ++i) {
    best[i * n + i + 1].bend = 0;
    normals[i * n + i + 1] = polygon.beside(i);
  }
  for (std::size_t span = 2; span < n; ++span)
    for (std::size_t i = 0; i + span < n; ++i) {
      const std::size_t k = i + span;
      if (!polygon.allows(i, k)) continue;
      for (std::size_t m = i + 1; m < k; ++m) {
        const Weight &left = best[i * n + m], &right = best[m * n + k];
        if (!left.is_possible() || !right.is_possible()) continue;
        const Eigen::Vector3d normal = polygon.normal_of(i, m, k);
        if (normal.isZero(0)) continue;
        Weight weight{std::max(left.bend, right.bend), left.area + right.area + polygon.area_of(i, m, k)};
        weight.bend = std::max({weight.bend, 1 - normal.dot(normals[i * n + m]), 1 - normal.dot(normals[m * n + k])});
        if (span + 1 == n) weight.bend = std::max(weight.bend, 1 - normal.dot(polygon.beside(n - 1)));
        if (!(weight < best[i * n + k]) || forbidden.contains({i, m, k})) continue;
        best[i * n + k] = weight;
        apex[i * n + k] = m;
        normals[i * n + k] = normal;
      }
    }
  if (!best[n - 1].is_possible()) return std::nullopt;
  std::vector<Places> triangles;
  std::vector<std::pair<std::size_t, std::size_t>> open{{0, n - 1}};
  while (!open.empty()) {
    const auto [i, k] = open.back();
    open.pop_back();
    if (k == i + 1) continue;
    const std::size_t m = apex[i * n + k];
    triangles.push_back({i, m, k});
    open.emplace_back(i, m);
    open.emplace_back(m, k);
  }
  return triangles;
}

/// All triangles over the sides of one that meets the mesh: most of them meet it, too.
void add_neighbours(const Polygon& polygon, const Places& places, std::set<Places>& neighbours) {
  for (std::size_t corner = 0; corner < 3; ++corner)
    for (std::size_t other = 0; other < polygon.size(); ++other) {
      Places p = places;
      if (std::find(p.begin(), p.end(), other) != p.end()) continue;
      p[corner] = other;
      std::sort(p.begin(), p.end());
      if (polygon.allows(p[0], p[1]) && polygon.allows(p[1], p[2]) && polygon.allows(p[0], p[2])) neighbours.insert(p);
    }
}

std::vector<Triangle> triangles_at(const Polygon& polygon, const std::vector<Places>& places) {
  std::vector<Triangle> triangles;
  triangles.reserve(places.size());
  for (const auto& [i, m, k] : places) triangles.push_back(polygon.triangle(i, m, k));
  return triangles;
}

/// All triangles of the polygon whose sides are allowed.
std::vector<Places> all_triangles(const Polygon& polygon) {
  std::vector<Places> all;
  for (std::size_t k = 2; k < polygon.size(); ++k)
    for (std::size_t i = 0; i + 1 < k; ++i) {
      if (!polygon.allows(i, k)) continue;
      for (std::size_t m = i + 1; m < k; ++m)
        if (polygon.allows(i, m) && polygon.allows(m, k)) all.push_back({i, m, k});
    }
  return all;
}

void forbid_those_that_meet(const Polygon& polygon, const TriangleMesh& mesh, const std::vector<Places>& triangles,
                            std::set<Places>& forbidden) {
  const std::vector<bool> meet = meeting_mesh(mesh, triangles_at(polygon, triangles));
  for (std::size_t i = 0; i < triangles.size(); ++i)
    if (meet[i]) forbidden.insert(triangles[i]);
}

/// Forbids, of the last triangles of `filled` and of their neighbours, those that meet the mesh, and the larger one of
/// two of them that meet; returns false if there is nothing to forbid.
bool forbid_guilty(const Polygon& polygon, const TriangleMesh& mesh, const std::vector<Places>& places,
                   std::set<Places>& forbidden) {
  TriangleMesh filled = mesh;
  for (const Triangle& t : triangles_at(polygon, places)) filled.triangles.push_back(t);
  const std::size_t first = mesh.triangles.size();
  const auto area = [&](const Places& p) { return polygon.area_of(p[0], p[1], p[2]); };
  const std::vector<std::pair<int, int>> cuts = self_intersecting_triangles(filled, first);
  std::set<Places> neighbours;
  for (const auto& [a, b] : cuts) {
    const Places& second = places[at(b) - first];
    if (at(a) < first) {
      forbidden.insert(second);
      add_neighbours(polygon, second, neighbours);
    } else {
      const Places& other = places[at(a) - first];
      forbidden.insert(area(other) > area(second) ? other : second);
    }
  }
  std::erase_if(neighbours, [&](const Places& p) { return forbidden.contains(p); });
  forbid_those_that_meet(polygon, mesh, {neighbours.begin(), neighbours.end()}, forbidden);
  return !cuts.empty();
}

}  // namespace

std::optional<std::vector<Triangle>> clear_filling(const TriangleMesh& mesh, const std::vector<int>& hole) {
  if (hole.size() > most_vertices) return std::nullopt;
  const Polygon polygon(mesh, hole);
  const auto n = static_cast<double>(polygon.size());
  const std::size_t rounds = std::min(most_rounds, 1 + static_cast<std::size_t>(6 * most_effort / (n * n * n)));
  std::set<Places> forbidden;
  if (hole.size() <= few_vertices) forbid_those_that_meet(polygon, mesh, all_triangles(polygon), forbidden);
  for (std::size_t round = 0; round < rounds; ++round) {
    const std::optional<std::vector<Places>> places = least_bent(polygon, forbidden);
    if (!places) return std::nullopt;
    if (!forbid_guilty(polygon, mesh, *places, forbidden)) return triangles_at(polygon, *places);
  }
  return std::nullopt;
}

}  // namespace rhizodont
