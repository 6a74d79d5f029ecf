// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// G. M. Morton, "A computer oriented geodetic data base and a new technique in file sequencing", 1966: the curve.
#include "mesh/space_order.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <tuple>

namespace rhizodont {
namespace {

constexpr int bits = 21;

/// The cell's three numbers, bit by bit in turn.
std::uint64_t cell_on_curve(const Point& p, double step) {
  if (!p.allFinite()) return std::numeric_limits<std::uint64_t>::max();
  constexpr double half = 1 << (bits - 1);
  std::uint64_t code = 0;
  for (Eigen::Index k = 0; k < 3; ++k) {
    const auto cell = static_cast<std::uint64_t>(std::clamp(std::floor(p[k] / step) + half, 0.0, 2 * half - 1));
    for (int bit = 0; bit < bits; ++bit) code |= (cell >> bit & 1U) << (3 * bit + k);
  }
  return code;
}

}  // namespace

std::vector<int> space_order(const std::vector<Point>& points, double step) {
  struct Key {
    std::uint64_t cell;
    Point point;
  };
  std::vector<Key> keys;
  keys.reserve(points.size());
  for (const Point& p : points) keys.push_back({cell_on_curve(p, step), p.allFinite() ? p : Point::Zero()});
  std::vector<int> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    const Key &first = keys[static_cast<std::size_t>(a)], &second = keys[static_cast<std::size_t>(b)];
    return std::tie(first.cell, first.point.x(), first.point.y(), first.point.z()) <
           std::tie(second.cell, second.point.x(), second.point.y(), second.point.z());
  });
  return order;
}

MeshOrder space_order(const TriangleMesh& mesh, double step) {
  std::vector<Point> middles;
  middles.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) {
    // From the smallest coordinate to the largest, so that the sum does not hang on where a triangle begins.
    Point middle;
    for (Eigen::Index k = 0; k < 3; ++k) {
      std::array<double, 3> along{};
      for (std::size_t i = 0; i < 3; ++i) along[i] = mesh.vertices[static_cast<std::size_t>(t[i])][k];
      std::sort(along.begin(), along.end());
      middle[k] = (along[0] + along[1] + along[2]) / 3;
    }
    middles.push_back(middle);
  }
  return {space_order(mesh.vertices, step), space_order(middles, step)};
}

TriangleMesh reordered(const TriangleMesh& mesh, const MeshOrder& order) {
  TriangleMesh result;
  result.vertices.reserve(order.vertices.size());
  std::vector<std::int32_t> place(order.vertices.size());
  for (std::size_t v = 0; v < order.vertices.size(); ++v) {
    result.vertices.push_back(mesh.vertices[static_cast<std::size_t>(order.vertices[v])]);
    place[static_cast<std::size_t>(order.vertices[v])] = static_cast<std::int32_t>(v);
  }
  result.triangles.reserve(order.triangles.size());
  for (const int t : order.triangles) {
    Triangle corners = mesh.triangles[static_cast<std::size_t>(t)];
    for (std::int32_t& v : corners) v = place[static_cast<std::size_t>(v)];
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    result.triangles.push_back(corners);
  }
  return result;
}

}  // namespace rhizodont
