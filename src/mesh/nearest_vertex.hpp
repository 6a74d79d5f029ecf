// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

#include <memory>
#include <span>
#include <vector>

namespace rhizodont {

struct NearVertex {
  int index = -1;               ///< into the points given to the index
  double squared_distance = 0;  ///< mm^2
};

/// Nearest points of a fixed set. Owns a copy of the points; queries may run in parallel.
/// Answers are sorted by distance, equal distances by lower index, and do not depend on the tree's shape.
class NearestVertexIndex {
 public:
  /// Throws InputError for an empty set or a non-finite point.
  explicit NearestVertexIndex(std::vector<Point> points);
  ~NearestVertexIndex();
  NearestVertexIndex(NearestVertexIndex&&) noexcept;
  NearestVertexIndex& operator=(NearestVertexIndex&&) noexcept;

  std::size_t size() const;
  const std::vector<Point>& points() const;

  NearVertex nearest(const Point& query) const;
  /// The k nearest, or all where there are fewer than k.
  std::vector<NearVertex> nearest(const Point& query, std::size_t k) const;
  /// Fills `found` with as many of the nearest as it has room for; returns how many there are. Allocates nothing.
  std::size_t nearest(const Point& query, std::span<NearVertex> found) const;
  /// All at most `radius` (mm) away.
  std::vector<NearVertex> within(const Point& query, double radius) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace rhizodont
