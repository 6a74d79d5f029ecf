// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

#include <array>
#include <vector>

namespace rhizodont {

/// The new triangles of a tooth as a mesh that can be changed locally. Half-edge h = 3 t + i runs from corner i of
/// triangle t to corner (i + 1) % 3. Vertices [0, fixed_vertices) belong to the crown: they stay where they are, and
/// no operation makes a new edge between two of them (the crown may have that edge already). The border never changes.
class PatchMesh {
 public:
  /// Precondition: oriented manifold; every border vertex is fixed and every fixed vertex used is on the border.
  PatchMesh(std::vector<Point> points, const std::vector<Triangle>& triangles, int fixed_vertices);

  std::vector<Point> points;

  static int next(int h) { return h % 3 == 2 ? h - 2 : h + 1; }
  static int previous(int h) { return h % 3 == 0 ? h + 2 : h - 1; }
  int half_edges() const { return static_cast<int>(opposite_.size()); }
  bool is_alive(int h) const { return corner_[static_cast<std::size_t>(h)] >= 0; }
  int from(int h) const { return corner_[static_cast<std::size_t>(h)]; }
  int to(int h) const { return corner_[static_cast<std::size_t>(next(h))]; }
  /// The corner of the half-edge's triangle that is not on it.
  int apex(int h) const { return corner_[static_cast<std::size_t>(previous(h))]; }
  /// -1 at the border.
  int opposite(int h) const { return opposite_[static_cast<std::size_t>(h)]; }
  bool is_fixed(int v) const { return v < fixed_; }
  int fixed_vertices() const { return fixed_; }
  /// A half-edge that leaves v (at a border vertex the one without a triangle before it); -1 if v is not in use.
  int leaving(int v) const { return leaving_[static_cast<std::size_t>(v)]; }

  /// Calls f(h) for the half-edges that leave v, counterclockwise.
  template <class F>
  void around(int v, F&& f) const {
    const int first = leaving(v);
    if (first < 0) return;
    int h = first;
    do {
      f(h);
      h = opposite(previous(h));
    } while (h >= 0 && h != first);
  }

  std::vector<int> neighbours(int v) const;
  bool has_edge(int a, int b) const;

  /// Whether the edge can be turned without making an edge that exists or one between two crown vertices.
  bool can_flip(int h) const;
  /// Puts the edge between the two apexes. Precondition: can_flip. Afterwards h is that edge.
  void flip(int h);

  /// Puts a vertex on an interior edge; returns its number.
  int split(int h, const Point& p);

  /// Whether the start of h, a free vertex, can be merged into its end.
  bool can_collapse(int h) const;
  /// Removes the start of h; what was around it is then around the end. Precondition: can_collapse.
  void collapse(int h);

  /// The triangles in use, in order.
  std::vector<Triangle> triangles() const;

 private:
  void set_triangle(int t, int a, int b, int c);
  void link(int g, int h);

  int fixed_;
  std::vector<int> corner_;    // per half-edge its start; -1 for a removed triangle
  std::vector<int> opposite_;  // per half-edge
  std::vector<int> leaving_;   // per vertex
};

}  // namespace rhizodont
