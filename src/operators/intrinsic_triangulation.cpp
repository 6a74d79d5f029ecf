// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// N. Sharp, K. Crane, "A Laplacian for Nonmanifold Triangle Meshes", Computer Graphics Forum 39(5), 2020.
// M. Fisher, B. Springborn, A. Bobenko, P. Schroeder, "An algorithm for the construction of intrinsic Delaunay
//   triangulations with applications to digital geometry processing", Computing 81, 2007.
#include "operators/intrinsic_triangulation.hpp"

#include "mesh/adjacency.hpp"

#include <algorithm>
#include <cmath>

namespace rhizodont {
namespace {

std::size_t next_in_triangle(std::size_t h) { return h % 3 == 2 ? h - 2 : h + 1; }
std::size_t previous_in_triangle(std::size_t h) { return h % 3 == 0 ? h + 2 : h - 1; }

/// Heron's formula in the order that keeps its accuracy for needles (W. Kahan).
double area_of_sides(double a, double b, double c) {
  if (a < b) std::swap(a, b);
  if (a < c) std::swap(a, c);
  if (b < c) std::swap(b, c);
  const double product = (a + (b + c)) * (c - (a - b)) * (c + (a - b)) * (a + (b - c));
  return 0.25 * std::sqrt(std::max(product, 0.0));
}

void lengthen(std::vector<double>& lengths, double margin) {
  double mean = 0;
  for (const double l : lengths) mean += l / static_cast<double>(lengths.size());
  double lack = 0;
  for (std::size_t h = 0; h < lengths.size(); ++h)
    lack =
        std::max(lack, margin * mean - (lengths[next_in_triangle(h)] + lengths[previous_in_triangle(h)] - lengths[h]));
  for (double& l : lengths) l += lack;
}

constexpr int no_twin = -1;

/// Turns edges until all are locally Delaunay.
class Flipper {
 public:
  Flipper(IntrinsicTriangulation& triangulation, std::vector<int> twins)
      : it_(triangulation), twin_(std::move(twins)), waiting_(twin_.size(), true) {}

  void run() {
    std::vector<std::size_t> stack;
    for (std::size_t h = twin_.size(); h-- > 0;) stack.push_back(h);
    // Ends by itself; the bound is for rounding alone.
    for (std::size_t left = 200 * twin_.size(); !stack.empty() && left > 0; --left) {
      const std::size_t h = stack.back();
      stack.pop_back();
      waiting_[h] = false;
      if (!should_flip(h)) continue;
      flip(h);
      const std::size_t t = h - h % 3, s = static_cast<std::size_t>(twin_[t]) / 3 * 3;
      for (const std::size_t side : {t + 1, t + 2, s + 1, s + 2}) {
        if (waiting_[side]) continue;
        waiting_[side] = true;
        stack.push_back(side);
      }
    }
  }

 private:
  bool should_flip(std::size_t h) const {
    if (twin_[h] == no_twin) return false;
    const auto other = static_cast<std::size_t>(twin_[h]);
    return other / 3 != h / 3 && opposite_cotangent(it_, h) + opposite_cotangent(it_, other) < -1e-9;
  }

  /// Distance from the foot of an edge's start to the corner, along and across the edge.
  static std::pair<double, double> laid_out(double edge, double from_start, double from_end) {
    const double x = (edge * edge + from_start * from_start - from_end * from_end) / (2 * edge);
    return {x, std::sqrt(std::max(from_start * from_start - x * x, 0.0))};
  }

  int corner(std::size_t h) const { return it_.triangles[h / 3][h % 3]; }

  /// After it the new edge is the first one of both triangles.
  void flip(std::size_t h) {
    const auto g = static_cast<std::size_t>(twin_[h]);
    const std::size_t bc = next_in_triangle(h), ca = previous_in_triangle(h);
    const std::size_t ad = next_in_triangle(g), db = previous_in_triangle(g);
    const auto [cx, cy] = laid_out(it_.lengths[h], it_.lengths[ca], it_.lengths[bc]);
    const auto [dx, dy] = laid_out(it_.lengths[h], it_.lengths[ad], it_.lengths[db]);
    const double diagonal = std::hypot(cx - dx, cy + dy);
    const int a = corner(h), b = corner(g), c = corner(ca), d = corner(db);
    const std::size_t t = h - h % 3, s = g - g % 3;
    struct Side {
      double length;
      int twin;
      std::size_t old;
    };
    const auto side = [&](std::size_t x) { return Side{it_.lengths[x], twin_[x], x}; };
    const Side sides[] = {side(db), side(bc), side(ca), side(ad)};
    const std::size_t places[] = {t + 1, t + 2, s + 1, s + 2};
    it_.triangles[t / 3] = {c, d, b};
    it_.triangles[s / 3] = {d, c, a};
    it_.lengths[t] = it_.lengths[s] = diagonal;
    twin_[t] = static_cast<int>(s);
    twin_[s] = static_cast<int>(t);
    const auto moved = [&](int twin) {  // sides of these two triangles may be each other's twins
      for (std::size_t i = 0; i < 4; ++i)
        if (twin == static_cast<int>(sides[i].old)) return static_cast<int>(places[i]);
      return twin;
    };
    for (std::size_t i = 0; i < 4; ++i) {
      it_.lengths[places[i]] = sides[i].length;
      twin_[places[i]] = moved(sides[i].twin);
    }
    for (const std::size_t place : places)
      if (twin_[place] != no_twin) twin_[static_cast<std::size_t>(twin_[place])] = static_cast<int>(place);
  }

  IntrinsicTriangulation& it_;
  std::vector<int> twin_;
  std::vector<bool> waiting_;
};

std::vector<int> twins_of(const TriangleMesh& mesh) {
  const EdgeTable edges = edge_table(mesh);
  std::vector<int> twins(3 * mesh.triangles.size(), no_twin);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if (edges.triangle_count(e) != 2) continue;
    const auto at = static_cast<std::size_t>(edges.first[e]);
    const int g = edges.half_edges[at], h = edges.half_edges[at + 1];
    if (half_edge_from(mesh, g) == half_edge_from(mesh, h)) continue;
    twins[static_cast<std::size_t>(g)] = h;
    twins[static_cast<std::size_t>(h)] = g;
  }
  return twins;
}

}  // namespace

double intrinsic_area(const IntrinsicTriangulation& triangulation, std::size_t triangle) {
  const double* l = &triangulation.lengths[3 * triangle];
  return area_of_sides(l[0], l[1], l[2]);
}

double opposite_cotangent(const IntrinsicTriangulation& triangulation, std::size_t half_edge) {
  const double a = triangulation.lengths[half_edge];
  const double b = triangulation.lengths[next_in_triangle(half_edge)];
  const double c = triangulation.lengths[previous_in_triangle(half_edge)];
  const double area = std::max(area_of_sides(a, b, c), 1e-14 * (a * a + b * b + c * c));
  return (b * b + c * c - a * a) / (4 * area);
}

IntrinsicTriangulation intrinsic_delaunay(const TriangleMesh& mesh, double margin) {
  IntrinsicTriangulation result;
  result.triangles = mesh.triangles;
  for (const Triangle& t : mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i)
      result.lengths.push_back(
          (mesh.vertices[static_cast<std::size_t>(t[i])] - mesh.vertices[static_cast<std::size_t>(t[(i + 1) % 3])])
              .norm());
  lengthen(result.lengths, margin);
  Flipper(result, twins_of(mesh)).run();
  return result;
}

}  // namespace rhizodont
