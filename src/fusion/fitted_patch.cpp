// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "fusion/fitted_patch.hpp"

#include "mesh/at.hpp"
#include "mesh/nearest_vertex.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace rhizodont {
namespace {

constexpr double outward_cosine = 0.3;  // a triangle's normal against the guiding surface's: up to 73 degrees

Eigen::Vector3d twice_area(const Point& a, const Point& b, const Point& c) { return (b - a).cross(c - a); }

}  // namespace

double smallest_angle(const Point& a, const Point& b, const Point& c) {
  const Eigen::Vector3d ab = b - a, bc = c - b, ca = a - c;
  const double lab = ab.squaredNorm(), lbc = bc.squaredNorm(), lca = ca.squaredNorm();
  // The smallest angle lies opposite to the shortest side.
  double dot = -ab.dot(bc), product = lab * lbc;
  if (lab <= lbc && lab <= lca) {
    dot = -bc.dot(ca);
    product = lbc * lca;
  } else if (lbc <= lca) {
    dot = -ca.dot(ab);
    product = lca * lab;
  }
  return product > 0 ? std::acos(std::clamp(dot / std::sqrt(product), -1.0, 1.0)) : 0.0;
}

FittedPatch::FittedPatch(const JoinedTooth& tooth, const SurfaceWalk& walk, const EdgeLengths& lengths)
    : walk_(walk),
      lengths_(lengths),
      mesh_(tooth.mesh.vertices, {tooth.mesh.triangles.begin() + tooth.crown_triangles, tooth.mesh.triangles.end()},
            tooth.crown_vertices),
      place_(tooth.mesh.vertices.size(), -1),
      size_(tooth.mesh.vertices.size(), 0),
      offset_(tooth.mesh.vertices.size(), Eigen::Vector3d::Zero()),
      frozen_(tooth.mesh.vertices.size(), 0) {
  for (std::size_t v = 0; v < place_.size(); ++v) {
    if (mesh_.leaving(static_cast<int>(v)) < 0) continue;
    const Point& p = mesh_.points[v];
    const SurfacePlace found = walk.closest(p, walk.triangle_near(p));
    place_[v] = found.triangle;
    offset_[v] = p - found.point;
  }
  renew_sizes();
}

void FittedPatch::freeze(const std::vector<Point>& centres, double radius) {
  if (centres.empty()) return;
  const NearestVertexIndex index(centres);
  for (std::size_t v = 0; v < frozen_.size(); ++v)
    if (place_[v] >= 0 && index.nearest(mesh_.points[v]).squared_distance <= radius * radius) frozen_[v] = 1;
}

double FittedPatch::relative_length(int h) const {
  const int a = mesh_.from(h), b = mesh_.to(h);
  return 2 * (point(a) - point(b)).norm() / (size(a) + size(b));
}

double FittedPatch::smallest_angle_at(int h) const {
  return smallest_angle(point(mesh_.from(h)), point(mesh_.to(h)), point(mesh_.apex(h)));
}

void FittedPatch::renew_sizes() {
  for (std::size_t v = 0; v < size_.size(); ++v)
    if (place_[v] >= 0 && (size_[v] <= 0 || !mesh_.is_fixed(static_cast<int>(v))))
      size_[v] = lengths_.at(mesh_.points[v]);
}

void FittedPatch::renew_offsets(double fading) {
  const std::vector<Eigen::Vector3d> before = offset_;
  for (int v = mesh_.fixed_vertices(); v < static_cast<int>(offset_.size()); ++v) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    int count = 0;
    mesh_.around(v, [&](int h) {
      const int w = mesh_.to(h);
      sum += std::exp(-(point(v) - point(w)).norm() / fading) * before[at(w)];
      ++count;
    });
    if (count > 0 && !is_frozen(v)) offset_[at(v)] = sum / count;
  }
}

SurfacePlace FittedPatch::fit(int v, const Point& p) const {
  SurfacePlace place = walk_.closest(p - offset_[at(v)], place_[at(v)]);
  place.point += offset_[at(v)];
  return place;
}

bool FittedPatch::faces_outward(const Point& a, const Point& b, const Point& c, int near) const {
  const Eigen::Vector3d n = twice_area(a, b, c);
  return n.dot(walk_.normal(place_[at(near)])) > outward_cosine * n.norm();
}

bool FittedPatch::can_move(int v, const SurfacePlace& place) const {
  if (is_frozen(v)) return false;
  bool good = true;
  mesh_.around(v, [&](int h) {
    const Point &b = point(mesh_.to(h)), &c = point(mesh_.apex(h));
    const Eigen::Vector3d after = twice_area(place.point, b, c);
    const double turned = after.dot(walk_.normal(place.triangle));
    if (turned >= outward_cosine * after.norm() && turned > 0) return;
    const Eigen::Vector3d before = twice_area(point(v), b, c);
    good = good && turned * before.norm() > before.dot(walk_.normal(place_[at(v)])) * after.norm();
  });
  return good;
}

void FittedPatch::move(int v, const SurfacePlace& place) {
  mesh_.points[at(v)] = place.point;
  place_[at(v)] = place.triangle;
}

bool FittedPatch::can_flip(int h) const {
  if (!mesh_.can_flip(h)) return false;
  const int g = mesh_.opposite(h);
  const int a = mesh_.from(h), b = mesh_.to(h), c = mesh_.apex(h), d = mesh_.apex(g);
  if (is_frozen(a) || is_frozen(b) || is_frozen(c) || is_frozen(d)) return false;
  return faces_outward(point(d), point(c), point(a), a) && faces_outward(point(c), point(d), point(b), b);
}

bool FittedPatch::can_split(int h) const {
  return mesh_.opposite(h) >= 0 && !is_frozen(mesh_.from(h)) && !is_frozen(mesh_.to(h));
}

int FittedPatch::split(int h) {
  const int a = mesh_.from(h), b = mesh_.to(h);
  const Eigen::Vector3d offset = 0.5 * (offset_[at(a)] + offset_[at(b)]);
  const Point middle = 0.5 * (point(a) + point(b));
  SurfacePlace place = walk_.closest(middle - offset, place_[at(a)]);
  place.point += offset;
  // Between two border vertices the guiding surface may be far: stay on the edge.
  if (mesh_.is_fixed(a) && mesh_.is_fixed(b)) place.point = middle;
  const int m = mesh_.split(h, place.point);
  place_.push_back(place.triangle);
  offset_.push_back(offset);
  size_.push_back(lengths_.at(place.point));
  frozen_.push_back(0);
  return m;
}

bool FittedPatch::can_collapse(int h) const {
  const int u = mesh_.from(h), v = mesh_.to(h);
  if (is_frozen(u) || is_frozen(v) || !mesh_.can_collapse(h)) return false;
  bool good = true;
  mesh_.around(u, [&](int k) {
    const int w = mesh_.to(k), x = mesh_.apex(k);
    if (w == v || x == v) return;
    good = good && faces_outward(point(v), point(w), point(x), w);
  });
  return good;
}

TriangleMesh FittedPatch::tooth(const JoinedTooth& before) const {
  TriangleMesh mesh;
  mesh.vertices.assign(before.mesh.vertices.begin(), before.mesh.vertices.begin() + before.crown_vertices);
  mesh.triangles.assign(before.mesh.triangles.begin(), before.mesh.triangles.begin() + before.crown_triangles);
  std::vector<int> number(mesh_.points.size(), -1);
  for (int v = 0; v < mesh_.fixed_vertices(); ++v) number[at(v)] = v;
  for (Triangle t : mesh_.triangles()) {
    for (std::int32_t& v : t) {
      int& now = number[at(v)];
      if (now < 0) {
        now = static_cast<int>(mesh.vertices.size());
        mesh.vertices.push_back(point(v));
      }
      v = now;
    }
    mesh.triangles.push_back(t);
  }
  return mesh;
}

}  // namespace rhizodont
