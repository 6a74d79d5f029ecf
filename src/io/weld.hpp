// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/io.hpp"

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace rhizodont {

/// Points known by the bits of their coordinates, with -0 and +0 the same, as they come in one after the other; of
/// points that are all there `first_at_place` tells the same.
class EqualPoints {
 public:
  explicit EqualPoints(std::size_t expected_points) { numbers_.reserve(expected_points + 16); }

  /// The place in `points` of a point equal to this one; if there is none, this one is appended. All points are new to
  /// `points` by this alone.
  std::int32_t number_in(const Point& point, std::vector<Point>& points);

 private:
  using Key = std::array<std::uint64_t, 3>;
  struct Hash {
    std::size_t operator()(const Key& key) const;
  };
  std::unordered_map<Key, std::int32_t, Hash> numbers_;
};

/// Merges vertices with equal coordinates where that closes a seam: where two triangles, or more, each have a border on
/// one and the same edge, where an edge has no length, and where two triangles are the same. The first stays, with its
/// attributes; the order is kept; `file.file_vertices` and `file.mesh_vertices` say which they were. An edge that has
/// its two triangles already is left alone, and so are sheets that touch in a point only: their file says that they are
/// not joined there, and joining them would make a vertex that no surface has. Notes how many were merged.
/// Precondition: indices in range, finite coordinates.
void weld_seams(MeshFile& file);

}  // namespace rhizodont
