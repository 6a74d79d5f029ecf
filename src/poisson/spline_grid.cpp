// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "poisson/spline_grid.hpp"

#include <algorithm>
#include <cmath>

#include "poisson/bspline.hpp"

namespace rhizodont {

SplinePosition locate(const SplineGrid& grid, const Point& p) {
  SplinePosition at{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<Eigen::Index>(axis);
    const double cells = grid.cells[axis];
    const double x = std::clamp((p[a] - grid.origin[a]) / grid.spacing, 0.0, cells);
    at.cell[axis] = static_cast<int>(std::min(std::floor(x), cells - 1.0));
    at.local[axis] = x - at.cell[axis];
    at.values[axis] = spline_values(grid.degree, at.local[axis]);
  }
  return at;
}

void add_refined(const SplineGrid& grid, const SplineField<double>& coarse, SplineField<double>& fine) {
  const SplineGrid parent = grid.coarser();
  const auto refinement = spline_tables(grid.degree).refinement;
  const auto half = [](int j) { return j >= 0 ? j / 2 : -((1 - j) / 2); };
  const auto last = [&](int axis) { return grid.functions(axis) + SplineGrid::halo; };
  for (int z = -SplineGrid::halo; z < last(2); ++z)
    for (int y = -SplineGrid::halo; y < last(1); ++y)
      for (int x = -SplineGrid::halo; x < last(0); ++x) {
        double sum = 0.0;
        for (int k = half(z) - 1; k <= half(z); ++k)
          for (int j = half(y) - 1; j <= half(y); ++j)
            for (int i = half(x) - 1; i <= half(x); ++i)
              sum += refinement[static_cast<std::size_t>(z - 2 * k)] * refinement[static_cast<std::size_t>(y - 2 * j)] *
                     refinement[static_cast<std::size_t>(x - 2 * i)] * coarse[parent.index(i, j, k)];
        fine[grid.index(x, y, z)] += sum;
      }
}

}  // namespace rhizodont
