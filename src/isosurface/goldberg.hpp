// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>

#include "rhizodont/mesh.hpp"

namespace rhizodont {

/// A vertex of the tiling in units of half the cubic constant: three numbers that are all even or all odd.
using LatticeVertex = std::array<std::int32_t, 3>;

/// A tetrahedron of the tiling. Its corners are A, B, C, D with long edges AC and BD; the other four edges are short.
/// `base` is A; the type says along which axes the long edges run: 2 t + 1 if BD lies on the upper side of AC along
/// axis t, else 2 t.
struct LatticeCell {
  LatticeVertex base;
  std::int32_t type;  ///< 0 .. 5

  friend bool operator==(const LatticeCell&, const LatticeCell&) = default;
};

/// Goldberg's tiling of space by congruent tetrahedra with a = sqrt(2) e / 4: in this case the vertices are a
/// body-centred cubic lattice with its diagonal along z, and the tetrahedra its disphenoids (short edges 1.0607 e,
/// long 1.2247 e).
class GoldbergTiling {
 public:
  /// Coordinates of vertices must stay below this, in size, to have a key.
  static constexpr std::int32_t limit = (1 << 19) - 4;

  /// `e`: side of the triangular lattice that the tiling stands on (mm).
  GoldbergTiling(double e, const Point& origin);

  Point position(const LatticeVertex& vertex) const;
  /// The vertex nearest to `p`. Precondition: `in_range(p)`.
  LatticeVertex nearest(const Point& p) const;
  bool in_range(const Point& p) const;

  static std::array<LatticeVertex, 4> corners(const LatticeCell& cell);
  /// The cell on the other side of the face opposite to a corner (0..3 = A..D).
  static LatticeCell across(const LatticeCell& cell, int corner);
  /// The 24 cells around a vertex, in a fixed order.
  static std::array<LatticeCell, 24> around(const LatticeVertex& vertex);

  /// Different for different vertices or cells within the limit; below 2^60 and 2^63.
  static std::uint64_t key(const LatticeVertex& vertex);
  static std::uint64_t key(const LatticeCell& cell);

 private:
  Eigen::Matrix3d axes_;        // from lattice units to mm
  Eigen::Matrix3d to_lattice_;  // and back
  Point origin_;
};

}  // namespace rhizodont
