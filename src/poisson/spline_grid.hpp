// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "rhizodont/mesh.hpp"

namespace rhizodont {

/// Knots of a tensor-product B-spline on a box of equal cells. The functions whose support lies in the box are numbered
/// from 0 along each axis: function i lives on the cells i .. i + degree. Those that stick out of the box have numbers
/// -degree .. -1 and functions(axis) .. functions(axis) + degree - 1.
struct SplineGrid {
  static constexpr int halo = 2;  ///< stored but not solved for, on every side

  int degree = 2;
  std::array<int, 3> cells = {0, 0, 0};
  Point origin = Point::Zero();  ///< lowest corner of the box (mm)
  double spacing = 1.0;          ///< mm

  int functions(int axis) const { return cells[static_cast<std::size_t>(axis)] - degree; }
  int stored(int axis) const { return functions(axis) + 2 * halo; }
  std::size_t row() const { return static_cast<std::size_t>(stored(0)); }
  std::size_t plane() const { return row() * static_cast<std::size_t>(stored(1)); }
  std::size_t size() const { return plane() * static_cast<std::size_t>(stored(2)); }
  /// Position in a field of function (x, y, z), each from -halo on; x runs fastest.
  std::size_t index(int x, int y, int z) const {
    return static_cast<std::size_t>(z + halo) * plane() + static_cast<std::size_t>(y + halo) * row() +
           static_cast<std::size_t>(x + halo);
  }
  /// Half as many cells of twice the size, from the same corner. Its functions are combinations of this grid's.
  SplineGrid coarser() const { return {degree, {cells[0] / 2, cells[1] / 2, cells[2] / 2}, origin, 2.0 * spacing}; }
};

/// Coefficients of a spline, with a halo that is zero where the spline vanishes on the box's border.
template <class Scalar>
using SplineField = std::vector<Scalar>;

/// Where a point lies: its cell, and the values there of the degree + 1 functions along each axis.
struct SplinePosition {
  std::array<int, 3> cell;
  std::array<std::array<double, 3>, 3> values;
  std::array<double, 3> local;  ///< in [0, 1] of the cell
};

/// Precondition: `p` finite; a point outside the box is moved to its border.
SplinePosition locate(const SplineGrid& grid, const Point& p);

/// Adds to `fine` the spline on `grid.coarser()` with the given coefficients, halo included.
void add_refined(const SplineGrid& grid, const SplineField<double>& coarse, SplineField<double>& fine);

}  // namespace rhizodont
