// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "arch/resolve_collisions.hpp"
#include "completion/steering.hpp"
#include "mesh/adjacency.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace rhizodont::test {

/// A tooth of circles: a crown above z = 0 and a root below, which leans and tapers.
struct TaperedTooth {
  Point neck = Point::Zero();  ///< middle of the crown's base
  double lean_x = 0;           ///< mm per mm of depth by which the root goes aside
  double lean_y = 0;
  double length = 14;
  double neck_radius = 2.5;
  double apex_radius = 0.7;
  int sides = 20;

  SourcedTooth solid() const {
    SourcedTooth tooth;
    constexpr double step = 0.5, crown_height = 6;
    const int rows = static_cast<int>(std::round((crown_height + length) / step));
    for (int row = 0; row <= rows; ++row) {
      const double z = crown_height - step * row, depth = std::max(0.0, -z);
      const double radius = neck_radius + (apex_radius - neck_radius) * depth / length;
      for (int k = 0; k < sides; ++k) {
        const double angle = 2 * std::numbers::pi * k / sides;
        add(tooth, Point(radius * std::cos(angle) + lean_x * depth, radius * std::sin(angle) + lean_y * depth, z));
      }
    }
    for (int row = 0; row < rows; ++row)
      for (int k = 0; k < sides; ++k) {
        const int a = row * sides + k, b = row * sides + (k + 1) % sides;
        tooth.mesh.triangles.push_back({a, b + sides, b});
        tooth.mesh.triangles.push_back({a, a + sides, b + sides});
      }
    const int top = static_cast<int>(tooth.mesh.vertices.size()), last = rows * sides;
    add(tooth, Point(0, 0, crown_height));
    add(tooth, Point(lean_x * length, lean_y * length, -length));
    for (int k = 0; k < sides; ++k) {
      tooth.mesh.triangles.push_back({k, (k + 1) % sides, top});
      tooth.mesh.triangles.push_back({last + (k + 1) % sides, last + k, top + 1});
    }
    return tooth;
  }

  /// The same with its root steered, as a tooth is made.
  SourcedTooth steered(int fdi, const RootSteering& steering) const {
    SourcedTooth tooth = solid();
    std::vector<bool> scan;
    for (const Triangle& t : tooth.mesh.triangles)
      scan.push_back(std::all_of(
          t.begin(), t.end(), [&](int v) { return tooth.source[static_cast<std::size_t>(v)] == VertexSource::scan; }));
    const TriangleMesh crown = submesh(tooth.mesh, scan).mesh;
    std::vector<Point> root;
    for (std::size_t v = 0; v < tooth.source.size(); ++v)
      if (tooth.source[v] != VertexSource::scan) root.push_back(tooth.mesh.vertices[v]);
    steer_root(root, crown, {}, fdi, steering);
    auto next = root.begin();
    for (std::size_t v = 0; v < tooth.source.size(); ++v)
      if (tooth.source[v] != VertexSource::scan) tooth.mesh.vertices[v] = *next++;
    return tooth;
  }

  /// For trials; it may be shortened by 2 mm.
  SteerableRoot trial(int fdi) const {
    const SourcedTooth tooth = solid();
    SteerableRoot root;
    root.fdi = fdi;
    root.triangles = tooth.mesh.triangles;
    root.source = tooth.source;
    root.vertices = [*this, fdi](const RootSteering& steering) { return steered(fdi, steering).mesh.vertices; };
    root.length = [*this, fdi](const RootSteering& steering) {
      double lowest = 0;
      for (const Point& p : steered(fdi, steering).mesh.vertices) lowest = std::min(lowest, p.z());
      return -lowest;
    };
    root.length_mm = length;
    root.shortest_mm = length - 2;
    return root;
  }

 private:
  void add(SourcedTooth& tooth, const Point& p) const {
    tooth.mesh.vertices.push_back(neck + p);
    tooth.source.push_back(p.z() > -1e-9 ? VertexSource::scan : VertexSource::predicted);
  }
};

}  // namespace rhizodont::test
