// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

#include <array>
#include <cstddef>
#include <vector>

namespace rhizodont {

/// Points on a cubic lattice, x running fastest.
struct Lattice {
  Point origin = Point::Zero();
  double cell = 1;             ///< mm
  std::array<int, 3> count{};  ///< >= 2 along each axis

  std::size_t size() const {
    return static_cast<std::size_t>(count[0]) * static_cast<std::size_t>(count[1]) * static_cast<std::size_t>(count[2]);
  }
  std::size_t index(int x, int y, int z) const {
    return static_cast<std::size_t>(x) +
           static_cast<std::size_t>(count[0]) *
               (static_cast<std::size_t>(y) + static_cast<std::size_t>(count[1]) * static_cast<std::size_t>(z));
  }
  Point at(int x, int y, int z) const { return origin + cell * Point(x, y, z); }
};

/// Where a function is 0.
struct ZeroSurface {
  TriangleMesh mesh;  ///< oriented towards growing values; its borders are on the lattice's sides
  /// Per vertex the two lattice points between which it lies and how far it is from the first to the second, 0..1.
  struct Between {
    std::size_t from = 0, to = 0;
    float share = 0;
  };
  std::vector<Between> between;
};

/// The surface where values given at a lattice's points are 0 (W. Lorensen, H. Cline, "Marching cubes: a high
/// resolution 3D surface construction algorithm", 1987), the cases found by walking around the cubes' faces; on a face
/// with two separate negative corners these stay apart on both sides of it. Vertices closer to a lattice point than a
/// twentieth of the cell are moved off it. Precondition: as many finite values as points.
ZeroSurface zero_surface(const Lattice& lattice, const std::vector<float>& values);

}  // namespace rhizodont
