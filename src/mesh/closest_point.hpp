// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

#include <memory>

namespace rhizodont {

struct ClosestPoint {
  Point point;          ///< on the surface
  int triangle = -1;    ///< that holds the point; one of them if several do
  double distance = 0;  ///< mm, >= 0
};

/// Answers which point of a mesh's surface is closest. Owns a copy of what it needs; queries may run in parallel.
/// Triangles without area are left out.
class ClosestPointIndex {
 public:
  /// Throws InputError for a mesh without any triangle that has area, or with a non-finite vertex or an index out of
  /// range.
  explicit ClosestPointIndex(const TriangleMesh& mesh);
  ~ClosestPointIndex();
  ClosestPointIndex(ClosestPointIndex&&) noexcept;
  ClosestPointIndex& operator=(ClosestPointIndex&&) noexcept;

  /// Precondition: finite coordinates.
  ClosestPoint closest(const Point& query) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace rhizodont
