// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "mesh/test_meshes.hpp"

#include <cmath>

namespace rhizodont::test {

/// Rectangle [0, width] x [0, height] in the plane z = 0, (columns + 1) x (rows + 1) vertices, facing up.
inline TriangleMesh rectangle(int columns, int rows, double width, double height) {
  TriangleMesh mesh;
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i) mesh.vertices.emplace_back(width * i / columns, height * j / rows, 0);
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      const int a = j * (columns + 1) + i, b = a + 1, c = b + columns, d = c + 1;
      if ((i + j) % 2 == 0) {
        mesh.triangles.push_back({a, b, d});
        mesh.triangles.push_back({a, d, c});
      } else {
        mesh.triangles.push_back({a, b, c});
        mesh.triangles.push_back({b, d, c});
      }
    }
  }
  return mesh;
}

/// The rectangle bent to a bowl: open, curved, no symmetry that makes eigenvalues equal.
inline TriangleMesh bowl(int size) {
  TriangleMesh mesh = rectangle(size, size, 1.3, 1);
  for (Point& p : mesh.vertices) p.z() = 0.5 * (p.x() - 0.6) * (p.x() - 0.6) + 0.8 * (p.y() - 0.45) * (p.y() - 0.45);
  return mesh;
}

}  // namespace rhizodont::test
