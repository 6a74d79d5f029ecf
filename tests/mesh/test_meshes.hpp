// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "mesh/adjacency.hpp"
#include "rhizodont/mesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

// Small meshes that every room's tests may use: `#include "mesh/test_meshes.hpp"`.
namespace rhizodont::test {

/// Corner (0,0,0) and the three unit vectors; volume 1/6, outward.
inline TriangleMesh tetrahedron() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
}

/// Unit cube [0,1]^3 with 12 triangles, outward.
inline TriangleMesh cube() {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) mesh.vertices.emplace_back(i & 1, (i >> 1) & 1, (i >> 2) & 1);
  const std::array<std::array<int, 4>, 6> quads{
      {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
  for (const auto& q : quads) {
    mesh.triangles.push_back({q[0], q[1], q[2]});
    mesh.triangles.push_back({q[0], q[2], q[3]});
  }
  return mesh;
}

/// Sphere of the given radius about the origin: an octahedron, each triangle cut in four `levels` times, vertices on
/// the sphere.
inline TriangleMesh sphere(int levels, double radius = 1) {
  TriangleMesh mesh{{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
                    {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int a, int b) {
      const auto [place, fresh] = middles.try_emplace(std::minmax(a, b), static_cast<int>(mesh.vertices.size()));
      if (fresh)
        mesh.vertices.push_back(
            (mesh.vertices[static_cast<std::size_t>(a)] + mesh.vertices[static_cast<std::size_t>(b)]).normalized());
      return place->second;
    };
    std::vector<Triangle> finer;
    for (const auto& [a, b, c] : mesh.triangles) {
      const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {Triangle{a, ab, ca}, Triangle{ab, b, bc}, Triangle{ca, bc, c}, Triangle{ab, bc, ca}});
    }
    mesh.triangles = std::move(finer);
  }
  for (Point& p : mesh.vertices) p *= radius;
  return mesh;
}

/// The triangles of `sphere` that lie in z >= 0: a dome, open below, with one border loop on the equator.
inline TriangleMesh dome(int levels, double radius = 1) {
  const TriangleMesh ball = sphere(levels, radius);
  std::vector<bool> above;
  for (const auto& [a, b, c] : ball.triangles) {
    const auto z = [&](int v) { return ball.vertices[static_cast<std::size_t>(v)].z(); };
    above.push_back(std::min({z(a), z(b), z(c)}) > -1e-9);
  }
  return submesh(ball, above).mesh;
}

/// The dome with a cut over its top, from one side nearly to the other: `gap` wide, in the plane y = 0.
inline TriangleMesh slit_dome(int levels, double radius, double gap) {
  TriangleMesh mesh = dome(levels, radius);
  std::vector<int> copy(mesh.vertices.size(), -1);
  for (Triangle& t : mesh.triangles) {
    double y = 0;
    for (const int v : t) y += mesh.vertices[static_cast<std::size_t>(v)].y();
    if (y < 0) continue;
    for (std::int32_t& v : t) {
      const Point p = mesh.vertices[static_cast<std::size_t>(v)];
      if (std::abs(p.y()) > 1e-9 || p.z() < 0.16 * radius) continue;
      int& c = copy[static_cast<std::size_t>(v)];
      if (c < 0) {
        c = static_cast<int>(mesh.vertices.size());
        mesh.vertices.push_back(p + Eigen::Vector3d(0, gap, 0));
      }
      v = c;
    }
  }
  return mesh;
}

/// Torus about the z axis, n x m quads, outward.
inline TriangleMesh torus(int n, int m, double big = 2, double small = 0.7) {
  TriangleMesh mesh;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < m; ++j) {
      const double u = 2 * std::numbers::pi * i / n, v = 2 * std::numbers::pi * j / m, r = big + small * std::cos(v);
      mesh.vertices.emplace_back(r * std::cos(u), r * std::sin(u), small * std::sin(v));
    }
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < m; ++j) {
      const int a = i * m + j, b = (i + 1) % n * m + j, c = (i + 1) % n * m + (j + 1) % m, d = i * m + (j + 1) % m;
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
    }
  return mesh;
}

/// Flat square [0, n]^2 at z = 0 with 2 n^2 triangles, normals up: a disc with one border loop.
inline TriangleMesh grid(int n) {
  TriangleMesh mesh;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) mesh.vertices.emplace_back(i, j, 0);
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = j * (n + 1) + i, b = a + 1, c = b + n + 1, d = a + n + 1;
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
    }
  return mesh;
}

/// Both meshes side by side in one.
inline TriangleMesh together(const TriangleMesh& a, const TriangleMesh& b, const Eigen::Vector3d& shift_of_b) {
  TriangleMesh both = a;
  const auto offset = static_cast<std::int32_t>(a.vertices.size());
  for (const Point& p : b.vertices) both.vertices.push_back(p + shift_of_b);
  for (const auto& [i, j, k] : b.triangles) both.triangles.push_back({i + offset, j + offset, k + offset});
  return both;
}

}  // namespace rhizodont::test
