// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <vector>

namespace rhizodont {

/// A growing set of points in the cells of a box, for searches within small radii.
class PointGrid {
 public:
  /// `cell`: mm, > 0; wider where the box would hold more than 200 cells along an axis.
  PointGrid(const Eigen::AlignedBox3d& box, double cell)
      : low_(box.min()), cell_(std::max(cell, box.sizes().maxCoeff() / 200)) {
    std::size_t cells = 1;
    for (std::size_t i = 0; i < 3; ++i) {
      count_[i] = static_cast<int>(box.sizes()[static_cast<Eigen::Index>(i)] / cell_) + 1;
      cells *= static_cast<std::size_t>(count_[i]);
    }
    first_.assign(cells, -1);
  }

  void add(const Point& p) {
    int& first = first_[cell_index(cell_of(p))];
    next_.push_back(first);
    first = static_cast<int>(points_.size());
    points_.push_back(p);
  }

  /// In the order in which points were added.
  const std::vector<Point>& points() const { return points_; }

  /// Calls f(index) for the points less than `radius` away, in no order.
  template <class F>
  void within(const Point& p, double radius, F&& f) const {
    const Cell low = cell_of(p - Point::Constant(radius));
    const Cell high = cell_of(p + Point::Constant(radius));
    for (int x = low[0]; x <= high[0]; ++x)
      for (int y = low[1]; y <= high[1]; ++y)
        for (int z = low[2]; z <= high[2]; ++z)
          for (int i = first_[cell_index({x, y, z})]; i >= 0; i = next_[static_cast<std::size_t>(i)])
            if ((points_[static_cast<std::size_t>(i)] - p).squaredNorm() < radius * radius) f(i);
  }

 private:
  using Cell = std::array<int, 3>;

  /// Of points outside the box, the nearest cell.
  Cell cell_of(const Point& p) const {
    Cell c;
    for (std::size_t i = 0; i < 3; ++i) {
      const double place = (p - low_)[static_cast<Eigen::Index>(i)] / cell_;
      c[i] = std::clamp(static_cast<int>(std::clamp(place, 0.0, 1e6)), 0, count_[i] - 1);
    }
    return c;
  }

  std::size_t cell_index(const Cell& c) const {
    return (static_cast<std::size_t>(c[0]) * static_cast<std::size_t>(count_[1]) + static_cast<std::size_t>(c[1])) *
               static_cast<std::size_t>(count_[2]) +
           static_cast<std::size_t>(c[2]);
  }

  Point low_;
  double cell_;
  Cell count_{};
  std::vector<int> first_;  // per cell: its newest point
  std::vector<int> next_;   // per point: the one before it in the same cell
  std::vector<Point> points_;
};

}  // namespace rhizodont
