// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Geometry>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "rhizodont/mesh.hpp"

namespace rhizodont {

/// Tensor-product B-splines of one knot spacing on a box of equal cells, stored only where they are needed. Functions
/// are numbered from 0 along each axis; function i lives on the cells i .. i + degree. Those that stick out of the box
/// are zero. Storage comes in blocks of 8 x 8 x 8 functions; a field is a row of blocks, x fastest within each.
struct SplineLevel {
  static constexpr int side = 8;                            ///< functions per side of a block
  static constexpr std::size_t block = side * side * side;  ///< functions per block
  using BlockNumber = std::array<std::int32_t, 3>;

  int degree = 2;
  double spacing = 1.0;                  ///< mm
  Point origin = Point::Zero();          ///< lowest corner of the box (mm)
  std::array<int, 3> cells = {0, 0, 0};  ///< of the box along each axis
  bool complete = false;                 ///< whether every function in the box is active
  std::vector<std::int32_t> directory;   ///< of all blocks of the box, x fastest: position among those stored, or -1
  std::vector<BlockNumber> blocks;       ///< the stored ones, in the order of the directory
  std::vector<std::array<std::int32_t, 27>> around;  ///< per stored block: it and those around it, x fastest, or -1
  std::vector<char> active;                          ///< per stored function: whether it is solved for
  std::size_t first = 0;                             ///< position of this level in fields that span all levels

  std::size_t size() const { return blocks.size() * block; }
  int functions(int axis) const { return cells[static_cast<std::size_t>(axis)] - degree; }
  int blocks_along(int axis) const { return (cells[static_cast<std::size_t>(axis)] + side - 1) / side; }
  std::size_t directory_size() const {
    return static_cast<std::size_t>(blocks_along(0)) * static_cast<std::size_t>(blocks_along(1)) *
           static_cast<std::size_t>(blocks_along(2));
  }
  /// Position of a block among those stored; -1 if it is not stored or lies outside the box.
  std::int32_t find(std::int32_t x, std::int32_t y, std::int32_t z) const {
    if (x < 0 || y < 0 || z < 0 || x >= blocks_along(0) || y >= blocks_along(1) || z >= blocks_along(2)) return -1;
    return directory[(static_cast<std::size_t>(z) * static_cast<std::size_t>(blocks_along(1)) +
                      static_cast<std::size_t>(y)) *
                         static_cast<std::size_t>(blocks_along(0)) +
                     static_cast<std::size_t>(x)];
  }
  /// Position of a function in a field of this level, or -1 if it is not stored.
  std::ptrdiff_t index(int x, int y, int z) const {
    if (x < 0 || y < 0 || z < 0) return -1;
    const std::int32_t b = find(x / side, y / side, z / side);
    return b < 0 ? -1
                 : static_cast<std::ptrdiff_t>(b) * static_cast<std::ptrdiff_t>(block) +
                       ((z % side) * side + y % side) * side + x % side;
  }
};

/// Where a point lies on a level: its cell, and the values there of the degree + 1 functions along each axis, those
/// numbered cell - degree .. cell.
struct SplinePosition {
  std::array<int, 3> cell;
  std::array<std::array<double, 3>, 3> values;
};

/// Precondition: `p` finite; a point outside the box is moved to its border.
std::array<int, 3> cell_of(const SplineLevel& level, const Point& p);
SplinePosition locate(const SplineLevel& level, const Point& p);

/// Calls visit(index in a field of the level, value at p) for the stored functions that do not vanish at p.
template <class Visit>
void for_each_function(const SplineLevel& level, const Point& p, const Visit& visit) {
  const SplinePosition at = locate(level, p);
  for (int k = 0; k <= level.degree; ++k)
    for (int j = 0; j <= level.degree; ++j)
      for (int i = 0; i <= level.degree; ++i) {
        const std::ptrdiff_t f =
            level.index(at.cell[0] - level.degree + i, at.cell[1] - level.degree + j, at.cell[2] - level.degree + k);
        if (f >= 0)
          visit(static_cast<std::size_t>(f), at.values[0][static_cast<std::size_t>(i)] *
                                                 at.values[1][static_cast<std::size_t>(j)] *
                                                 at.values[2][static_cast<std::size_t>(k)]);
      }
}

/// What `build_levels` needs to know of a sample.
struct LevelSample {
  Point position;  ///< mm
  int finest;      ///< finest level with functions of its own around the sample
};

struct LevelOptions {
  int degree = 2;
  double spacing = 0.2;     ///< mm: of the finest level
  double margin = 1.0;      ///< mm: least distance of the samples from the box's border
  int complete_cells = 32;  ///< a level with at most so many cells along the longest side is complete
};

/// How many levels a box takes, its corner and its cells on the coarsest level, whose cells are 2^(count - 1) times as
/// large as those of the finest.
struct LevelLayout {
  int count = 1;
  Point origin = Point::Zero();
  std::array<int, 3> coarsest_cells = {4, 4, 4};
  double coarsest_spacing = 1.0;

  double spacing(int level) const { return coarsest_spacing / static_cast<double>(1 << level); }
  double directory_size() const;  ///< blocks of the finest level's box
};

LevelLayout lay_out_levels(const Eigen::AlignedBox3d& samples, const LevelOptions& options);

/// Levels from the coarsest to the finest. Each holds what is needed around the samples that reach so deep, and all
/// coarser functions that its own functions are part of, so that a function summed over the levels up to some level
/// can be written exactly in the stored functions of that level wherever that level is stored.
std::vector<SplineLevel> build_levels(const LevelLayout& layout, const std::vector<LevelSample>& samples,
                                      const LevelOptions& options);

}  // namespace rhizodont
