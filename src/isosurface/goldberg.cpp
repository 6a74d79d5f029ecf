// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Goldberg, Three infinite families of tetrahedral space-fillers, 1974; the case used by Hass and Trnkova,
// Approximating isosurfaces by guaranteed-quality triangular meshes, 2020.
#include "isosurface/goldberg.hpp"

#include <cassert>
#include <cmath>

namespace rhizodont {
namespace {

LatticeVertex plus(LatticeVertex vertex, int axis, std::int32_t amount) {
  vertex[static_cast<std::size_t>(axis)] += amount;
  return vertex;
}

}  // namespace

GoldbergTiling::GoldbergTiling(double e, const Point& origin) : origin_(origin) {
  const double half_constant = 0.5 * std::sqrt(1.5) * e;
  Eigen::Matrix3d turn;  // rows: the new x, y, z; the lattice's diagonal becomes z
  turn.row(0) = Eigen::RowVector3d(2.0, -1.0, -1.0) / std::sqrt(6.0);
  turn.row(1) = Eigen::RowVector3d(0.0, 1.0, -1.0) / std::sqrt(2.0);
  turn.row(2) = Eigen::RowVector3d(1.0, 1.0, 1.0) / std::sqrt(3.0);
  axes_ = half_constant * turn;
  to_lattice_ = turn.transpose() / half_constant;
}

Point GoldbergTiling::position(const LatticeVertex& vertex) const {
  return origin_ + axes_ * Eigen::Vector3d(vertex[0], vertex[1], vertex[2]);
}

bool GoldbergTiling::in_range(const Point& p) const {
  return ((to_lattice_ * (p - origin_)).array().abs() < limit / 2).all();
}

LatticeVertex GoldbergTiling::nearest(const Point& p) const {
  assert(in_range(p));
  const Eigen::Array3d x = (to_lattice_ * (p - origin_)).array();
  const Eigen::Array3d even = 2.0 * (0.5 * x).round(), odd = 2.0 * (0.5 * (x - 1.0)).round() + 1.0;
  const Eigen::Array3d best = (x - even).square().sum() <= (x - odd).square().sum() ? even : odd;
  return {static_cast<std::int32_t>(best[0]), static_cast<std::int32_t>(best[1]), static_cast<std::int32_t>(best[2])};
}

std::array<LatticeVertex, 4> GoldbergTiling::corners(const LatticeCell& cell) {
  const int third = cell.type / 2, first = (third + 1) % 3, second = (third + 2) % 3;
  const LatticeVertex middle = plus(plus(cell.base, first, 1), third, cell.type % 2 == 1 ? 1 : -1);
  return {cell.base, plus(middle, second, -1), plus(cell.base, first, 2), plus(middle, second, 1)};
}

LatticeCell GoldbergTiling::across(const LatticeCell& cell, int corner) {
  // The face keeps one long edge. Around a long edge the four cells turn: the neighbour has that edge and, of the ring
  // of four vertices around it, the one that the face has and the next one; these two are its other long edge.
  const int third = cell.type / 2, first = (third + 1) % 3, second = (third + 2) % 3;
  const std::array<LatticeVertex, 4> at = corners(cell);
  if (corner == 0 || corner == 2) return {at[1], 2 * first + (corner == 0 ? 1 : 0)};
  const bool towards_d = corner == 1;
  const LatticeVertex middle = plus(plus(cell.base, first, 1), second, towards_d ? 1 : -1);
  return {plus(middle, third, -1), 2 * second + (towards_d ? 0 : 1)};
}

std::array<LatticeCell, 24> GoldbergTiling::around(const LatticeVertex& vertex) {
  std::array<LatticeCell, 24> cells;
  for (std::int32_t type = 0; type < 6; ++type) {
    const auto offsets = corners({{0, 0, 0}, type});
    for (std::size_t c = 0; c < 4; ++c) {
      const LatticeVertex base{vertex[0] - offsets[c][0], vertex[1] - offsets[c][1], vertex[2] - offsets[c][2]};
      cells[static_cast<std::size_t>(type) * 4 + c] = {base, type};
    }
  }
  return cells;
}

std::uint64_t GoldbergTiling::key(const LatticeVertex& vertex) {
  std::uint64_t packed = 0;
  for (const std::int32_t x : vertex) packed = (packed << 20) | static_cast<std::uint64_t>(x + (1 << 19));
  return packed;
}

std::uint64_t GoldbergTiling::key(const LatticeCell& cell) {
  return (key(cell.base) << 3) | static_cast<std::uint64_t>(cell.type);
}

}  // namespace rhizodont
