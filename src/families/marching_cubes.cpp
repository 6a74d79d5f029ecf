// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "families/marching_cubes.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <utility>

namespace rhizodont {
namespace {

// Corner c of a cube is at x = c & 1, y = c >> 1 & 1, z = c >> 2 & 1. An edge runs along an axis from its lower corner.
constexpr int axis_of(int a, int b) { return std::countr_zero(static_cast<unsigned>(a ^ b)); }
constexpr int edge_number(int a, int b) { return 8 * axis_of(a, b) + std::min(a, b); }

// Corners of the faces, counterclockwise when seen from outside.
constexpr std::array<std::array<int, 4>, 6> faces{
    {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};

/// Polygons of a case, each a loop of edge numbers.
using Polygons = std::vector<std::vector<int>>;

Polygons polygons_of(unsigned negative) {
  std::array<int, 24> next{};
  next.fill(-1);
  const auto inside = [&](int corner) { return ((negative >> corner) & 1) != 0; };
  for (const auto& face : faces) {
    for (std::size_t i = 0; i < 4; ++i) {
      // A run of negative corners begins at corner i; the surface cuts it off.
      if (!inside(face[i]) || inside(face[(i + 3) % 4])) continue;
      std::size_t last = i;
      while (inside(face[(last + 1) % 4])) last = (last + 1) % 4;
      const int entry = edge_number(face[(i + 3) % 4], face[i]), exit = edge_number(face[last], face[(last + 1) % 4]);
      next[static_cast<std::size_t>(entry)] = exit;
    }
  }
  Polygons polygons;
  for (std::size_t start = 0; start < next.size(); ++start) {
    if (next[start] < 0) continue;
    std::vector<int> loop;
    for (int at = static_cast<int>(start); at >= 0; at = std::exchange(next[static_cast<std::size_t>(at)], -1))
      loop.push_back(at);
    loop.pop_back();  // the start again
    polygons.push_back(std::move(loop));
  }
  return polygons;
}

bool on_one_face(int edge_a, int edge_b) {
  const auto corners = [](int edge) { return std::array<int, 2>{edge % 8, edge % 8 | 1 << (edge / 8)}; };
  const auto a = corners(edge_a), b = corners(edge_b);
  return std::any_of(faces.begin(), faces.end(), [&](const std::array<int, 4>& face) {
    const auto holds = [&](int corner) { return std::find(face.begin(), face.end(), corner) != face.end(); };
    return holds(a[0]) && holds(a[1]) && holds(b[0]) && holds(b[1]);
  });
}

/// Triangles of a case: three edge numbers each.
std::vector<std::array<int, 3>> triangles_of(unsigned negative) {
  std::vector<std::array<int, 3>> triangles;
  for (std::vector<int> loop : polygons_of(negative)) {
    // A fan whose diagonals run through the cube, not in a face, where the next cube's could coincide with them.
    const auto diagonals_in_faces = [&](std::size_t apex) {
      int bad = 0;
      for (std::size_t k = 2; k + 1 < loop.size(); ++k) bad += on_one_face(loop[apex], loop[(apex + k) % loop.size()]);
      return bad;
    };
    std::size_t best = 0;
    for (std::size_t apex = 1; apex < loop.size(); ++apex)
      if (diagonals_in_faces(apex) < diagonals_in_faces(best)) best = apex;
    std::rotate(loop.begin(), loop.begin() + static_cast<std::ptrdiff_t>(best), loop.end());
    for (std::size_t k = 1; k + 1 < loop.size(); ++k) triangles.push_back({loop[0], loop[k], loop[k + 1]});
  }
  return triangles;
}

const std::array<std::vector<std::array<int, 3>>, 256>& cases() {
  static const auto table = [] {
    std::array<std::vector<std::array<int, 3>>, 256> all;
    for (unsigned negative = 0; negative < 256; ++negative) all[negative] = triangles_of(negative);
    return all;
  }();
  return table;
}

}  // namespace

ZeroSurface zero_surface(const Lattice& lattice, const std::vector<float>& values) {
  const auto& table = cases();
  const auto [nx, ny, nz] = lattice.count;
  const std::array<std::size_t, 3> stride{1, static_cast<std::size_t>(nx),
                                          static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny)};
  // Vertices on the edges of two layers of points: [layer parity][point in the layer][axis].
  std::vector<std::array<std::int32_t, 3>> above(stride[2], {-1, -1, -1}), below = above;
  ZeroSurface surface;
  const auto vertex_on = [&](std::size_t point, std::size_t axis, int x, int y, int z, std::int32_t& slot) {
    if (slot >= 0) return slot;
    const std::size_t other = point + stride[axis];
    const float share = std::clamp(values[point] / (values[point] - values[other]), 0.05F, 0.95F);
    Point p = lattice.at(x, y, z);
    p[static_cast<Eigen::Index>(axis)] += lattice.cell * static_cast<double>(share);
    slot = static_cast<std::int32_t>(surface.mesh.vertices.size());
    surface.mesh.vertices.push_back(p);
    surface.between.push_back({point, other, share});
    return slot;
  };
  for (int z = 0; z + 1 < nz; ++z) {
    std::swap(below, above);
    std::fill(above.begin(), above.end(), std::array<std::int32_t, 3>{-1, -1, -1});
    for (int y = 0; y + 1 < ny; ++y) {
      for (int x = 0; x + 1 < nx; ++x) {
        const std::size_t base = lattice.index(x, y, z);
        unsigned negative = 0;
        for (unsigned c = 0; c < 8; ++c)
          negative |= static_cast<unsigned>(
                          values[base + (c & 1) * stride[0] + (c >> 1 & 1) * stride[1] + (c >> 2) * stride[2]] < 0)
                      << c;
        if (negative == 0 || negative == 255) continue;
        for (const std::array<int, 3>& edges : table[negative]) {
          Triangle triangle{};
          for (std::size_t k = 0; k < 3; ++k) {
            const int corner = edges[k] % 8, dx = corner & 1, dy = corner >> 1 & 1, dz = corner >> 2;
            const auto axis = static_cast<std::size_t>(edges[k] / 8);
            const std::size_t point = lattice.index(x + dx, y + dy, z + dz);
            auto& layer = dz == 0 ? below : above;
            triangle[k] = vertex_on(point, axis, x + dx, y + dy, z + dz, layer[point % stride[2]][axis]);
          }
          surface.mesh.triangles.push_back(triangle);
        }
      }
    }
  }
  return surface;
}

}  // namespace rhizodont
