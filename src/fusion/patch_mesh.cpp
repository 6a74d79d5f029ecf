// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// T. Dey, H. Edelsbrunner, S. Guha and D. Nekhayev, "Topology preserving edge contraction", 1999: the link condition.

#include "fusion/patch_mesh.hpp"

#include <algorithm>
#include <cassert>
#include <unordered_map>

namespace rhizodont {

PatchMesh::PatchMesh(std::vector<Point> positions, const std::vector<Triangle>& triangles, int fixed_vertices)
    : points(std::move(positions)), fixed_(fixed_vertices) {
  corner_.reserve(3 * triangles.size());
  for (const Triangle& t : triangles) corner_.insert(corner_.end(), t.begin(), t.end());
  opposite_.assign(corner_.size(), -1);
  leaving_.assign(points.size(), -1);
  std::unordered_map<std::uint64_t, int> open;
  open.reserve(corner_.size());
  const auto key = [](int a, int b) {
    return (static_cast<std::uint64_t>(static_cast<std::uint32_t>(a)) << 32) | static_cast<std::uint32_t>(b);
  };
  for (int h = 0; h < half_edges(); ++h) open.emplace(key(from(h), to(h)), h);
  for (int h = 0; h < half_edges(); ++h) {
    const auto found = open.find(key(to(h), from(h)));
    if (found != open.end()) opposite_[static_cast<std::size_t>(h)] = found->second;
  }
  for (int h = 0; h < half_edges(); ++h) {
    int& first = leaving_[static_cast<std::size_t>(from(h))];
    if (first < 0 || opposite(h) < 0) first = h;
  }
}

std::vector<int> PatchMesh::neighbours(int v) const {
  std::vector<int> result;
  int last = -1;
  around(v, [&](int h) {
    result.push_back(to(h));
    last = h;
  });
  if (last >= 0 && opposite(previous(last)) < 0) result.push_back(apex(last));
  return result;
}

bool PatchMesh::has_edge(int a, int b) const {
  bool found = false;
  around(a, [&](int h) { found = found || to(h) == b || apex(h) == b; });
  return found;
}

bool PatchMesh::can_flip(int h) const {
  const int g = opposite(h);
  if (g < 0) return false;
  const int a = apex(h), b = apex(g);
  return !(is_fixed(a) && is_fixed(b)) && a != b && !has_edge(a, b);
}

void PatchMesh::set_triangle(int t, int a, int b, int c) {
  corner_[static_cast<std::size_t>(3 * t)] = a;
  corner_[static_cast<std::size_t>(3 * t + 1)] = b;
  corner_[static_cast<std::size_t>(3 * t + 2)] = c;
}

void PatchMesh::link(int g, int h) {
  if (g >= 0) opposite_[static_cast<std::size_t>(g)] = h;
  if (h >= 0) opposite_[static_cast<std::size_t>(h)] = g;
}

void PatchMesh::flip(int h) {
  assert(can_flip(h));
  // (a, b, c) and (b, a, d) become (d, c, a) and (c, d, b), with the edge c - d in the place of a - b.
  const int g = opposite(h);
  const int a = from(h), b = to(h), c = apex(h), d = apex(g);
  const int bc = opposite(next(h)), ca = opposite(previous(h));
  const int ad = opposite(next(g)), db = opposite(previous(g));
  const auto lay = [&](int edge, int p, int q, int r) {
    corner_[static_cast<std::size_t>(edge)] = p;
    corner_[static_cast<std::size_t>(next(edge))] = q;
    corner_[static_cast<std::size_t>(previous(edge))] = r;
  };
  lay(h, d, c, a);
  lay(g, c, d, b);
  link(next(h), ca);
  link(previous(h), ad);
  link(next(g), db);
  link(previous(g), bc);
  const auto renew = [&](int v, int edge) {
    int& first = leaving_[static_cast<std::size_t>(v)];
    first = edge;
    // At a border vertex the fan has to start at its border.
    for (int turn = edge; opposite(turn) >= 0;) {
      turn = next(opposite(turn));
      first = turn;
      if (turn == edge) break;
    }
  };
  renew(a, previous(h));
  renew(b, previous(g));
  renew(c, next(h));
  renew(d, next(g));
}

int PatchMesh::split(int h, const Point& p) {
  // (a, b, c) becomes (a, m, c) and (m, b, c); (b, a, d) becomes (b, m, d) and (m, a, d).
  const int g = opposite(h);
  const int a = from(h), b = to(h), c = apex(h), d = apex(g);
  const int bc = opposite(next(h)), ad = opposite(next(g));
  const int m = static_cast<int>(points.size());
  points.push_back(p);
  leaving_.push_back(-1);
  const int t = half_edges() / 3;
  const auto grow = [&](int x, int y, int z) {
    corner_.insert(corner_.end(), {x, y, z});
    opposite_.insert(opposite_.end(), {-1, -1, -1});
  };
  grow(m, b, c);  // 3 t
  grow(m, a, d);  // 3 t + 3
  corner_[static_cast<std::size_t>(next(h))] = m;
  corner_[static_cast<std::size_t>(next(g))] = m;
  // h: a -> m, g: b -> m.
  link(3 * t + 1, bc);
  link(3 * t + 2, next(h));
  link(3 * t, g);
  link(3 * t + 4, ad);
  link(3 * t + 5, next(g));
  link(3 * t + 3, h);
  leaving_[static_cast<std::size_t>(m)] = 3 * t;
  const auto renew = [&](int v, int old, int now) {
    if (leaving_[static_cast<std::size_t>(v)] == old) leaving_[static_cast<std::size_t>(v)] = now;
  };
  renew(b, next(h), 3 * t + 1);
  renew(a, next(g), 3 * t + 4);
  return m;
}

bool PatchMesh::can_collapse(int h) const {
  const int u = from(h), v = to(h);
  if (is_fixed(u) || opposite(h) < 0) return false;
  const std::vector<int> of_v = neighbours(v);
  int common = 0;
  bool crowded = false;
  int valence = 0;
  around(u, [&](int k) {
    ++valence;
    const int w = to(k);
    if (w == v) return;
    const bool shared = std::find(of_v.begin(), of_v.end(), w) != of_v.end();
    common += shared ? 1 : 0;
    crowded = crowded || (!shared && is_fixed(v) && is_fixed(w));
  });
  if (common != 2 || crowded || valence < 4) return false;
  // The two vertices beside the edge lose one neighbour each.
  for (const int w : {apex(h), apex(opposite(h))})
    if (!is_fixed(w) && neighbours(w).size() < 4) return false;
  return true;
}

void PatchMesh::collapse(int h) {
  assert(can_collapse(h));
  const int g = opposite(h);
  const int u = from(h), v = to(h), c = apex(h), d = apex(g);
  std::vector<int> leaving_u;
  around(u, [&](int k) { leaving_u.push_back(k); });
  for (const int k : leaving_u) corner_[static_cast<std::size_t>(k)] = v;
  const int vc = opposite(next(h)), cu = opposite(previous(h));
  const int ud = opposite(next(g)), dv = opposite(previous(g));
  link(cu, vc);
  link(ud, dv);
  for (const int t : {h / 3, g / 3}) {
    set_triangle(t, -1, -1, -1);
    for (int i = 0; i < 3; ++i) opposite_[static_cast<std::size_t>(3 * t + i)] = -1;
  }
  leaving_[static_cast<std::size_t>(u)] = -1;
  // Triangles that survive beside the collapsed ones give the three remaining vertices a half-edge.
  const auto renew = [&](int x, int edge) {
    int first = edge;
    for (int turn = edge; opposite(turn) >= 0;) {
      turn = next(opposite(turn));
      first = turn;
      if (turn == edge) break;
    }
    leaving_[static_cast<std::size_t>(x)] = first;
  };
  // cu runs u' -> c: it leaves v now; ud runs d -> u': its next leaves v.
  renew(c, next(cu));
  renew(v, cu);
  renew(d, ud);
}

std::vector<Triangle> PatchMesh::triangles() const {
  std::vector<Triangle> result;
  for (int h = 0; h < half_edges(); h += 3)
    if (is_alive(h)) result.push_back({from(h), from(h + 1), from(h + 2)});
  return result;
}

}  // namespace rhizodont
