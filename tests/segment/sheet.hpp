// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

#include <functional>

namespace rhizodont::test {

/// A sheet over the unit square, rows of vertices one after the other.
inline TriangleMesh sheet(int columns, int rows, const std::function<Point(double, double)>& at) {
  TriangleMesh mesh;
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) mesh.vertices.push_back(at(i / (columns - 1.0), j / (rows - 1.0)));
  for (int j = 0; j + 1 < rows; ++j)
    for (int i = 0; i + 1 < columns; ++i) {
      const int v = columns * j + i;
      mesh.triangles.push_back({v, v + 1, v + columns + 1});
      mesh.triangles.push_back({v, v + columns + 1, v + columns});
    }
  return mesh;
}

}  // namespace rhizodont::test
