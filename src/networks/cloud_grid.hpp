// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace rhizodont {

/// Points of a surface in the cells of a grid: neighbours within a short way are found without a tree. `xyz` holds x,
/// y, z of point 0, then of point 1 and so on, finite values; it must outlive the grid.
class CloudGrid {
 public:
  /// `cell`: edge of a cell, > 0; made larger where the grid would have more than some millions of cells.
  CloudGrid(std::span<const float> xyz, float cell);

  /// Indices of the `k` points nearest to each query, nearest first, ties to the smaller index: queries x k. With fewer
  /// points than k, the nearest one stands in the places left. Throws UsageError if there are queries but no points.
  std::vector<std::int32_t> nearest(std::span<const float> queries_xyz, int k) const;

  /// Calls visit(index) for the points in all cells that touch the ball; some lie outside of it.
  template <class Visit>
  void visit_near(const float* query, float radius, const Visit& visit) const {
    std::array<int, 3> low{}, high{};
    for (std::size_t a = 0; a < 3; ++a) {
      low[a] = cell_of(query[a] - radius, a);
      high[a] = cell_of(query[a] + radius, a);
    }
    for (int z = low[2]; z <= high[2]; ++z)
      for (int y = low[1]; y <= high[1]; ++y)
        for (int x = low[0]; x <= high[0]; ++x) {
          const std::size_t c = number_of(x, y, z);
          for (std::int32_t i = first_[c]; i < first_[c + 1]; ++i) visit(order_[static_cast<std::size_t>(i)]);
        }
  }

 private:
  int cell_of(float value, std::size_t axis) const;
  std::size_t number_of(int x, int y, int z) const {
    return static_cast<std::size_t>((z * size_[1] + y) * size_[0] + x);
  }
  void nearest_of(const float* query, int k, std::int32_t* result) const;

  std::span<const float> xyz_;
  float cell_;
  std::array<float, 3> low_{};
  std::array<int, 3> size_{1, 1, 1};
  std::vector<std::int32_t> first_, order_;
};

/// One point of each cell of a grid with edge `spacing` through the origin: the one nearest to the mean of those in the
/// cell, of those that are about as near the smallest index. In the order of cells, x fastest.
std::vector<std::int32_t> thinned(std::span<const float> xyz, float spacing);

}  // namespace rhizodont
