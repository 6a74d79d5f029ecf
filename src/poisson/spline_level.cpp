// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Splines on the nodes of an octree that is refined near the samples (Kazhdan, Bolitho and Hoppe 2006), eight by eight
// by eight nodes at a time.
#include "poisson/spline_level.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "base/parallel_tasks.hpp"
#include "poisson/bspline.hpp"

namespace rhizodont {
namespace {

/// Calls `visit(x, y, z)` for all block numbers that hold functions `low` .. `high` along each axis, within the box.
template <class Visit>
void for_blocks(const SplineLevel& level, const std::array<int, 3>& low, const std::array<int, 3>& high,
                const Visit& visit) {
  std::array<int, 3> from{}, to{};
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    from[a] = std::max(low[a], 0) / SplineLevel::side;
    to[a] = std::min(high[a] / SplineLevel::side, level.blocks_along(axis) - 1);
    if (high[a] < 0) return;
  }
  for (int z = from[2]; z <= to[2]; ++z)
    for (int y = from[1]; y <= to[1]; ++y)
      for (int x = from[0]; x <= to[0]; ++x) visit(x, y, z);
}

void mark(SplineLevel& level, int x, int y, int z) {
  const auto width = static_cast<std::size_t>(level.blocks_along(0));
  const auto height = static_cast<std::size_t>(level.blocks_along(1));
  level.directory[(static_cast<std::size_t>(z) * height + static_cast<std::size_t>(y)) * width +
                  static_cast<std::size_t>(x)] = 0;
}

/// Functions first[axis] .. last[axis] along each axis.
struct FunctionBox {
  std::array<int, 3> first, last;
};

/// What is active around the samples that reach so deep: all functions that are part of the coarser functions which do
/// not vanish at a sample. Whole families of that kind matter: a coarse function of which almost all but not all parts
/// were active would be almost, but not quite, a sum of fine ones, and no iteration could tell the two apart quickly.
std::vector<FunctionBox> sampled_boxes(const SplineLevel& level, int number, const std::vector<LevelSample>& samples) {
  std::vector<std::array<int, 3>> coarse_cells;
  for (const LevelSample& sample : samples) {
    if (sample.finest < number) continue;
    const std::array<int, 3> cell = cell_of(level, sample.position);
    coarse_cells.push_back({cell[0] / 2, cell[1] / 2, cell[2] / 2});
  }
  std::ranges::sort(coarse_cells);
  const auto repeated = std::ranges::unique(coarse_cells);
  coarse_cells.erase(repeated.begin(), repeated.end());
  std::vector<FunctionBox> boxes;
  for (const std::array<int, 3>& cell : coarse_cells) {
    FunctionBox box{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      box.first[axis] = 2 * (cell[axis] - level.degree);
      box.last[axis] = 2 * cell[axis] + level.degree + 1;
    }
    boxes.push_back(box);
  }
  return boxes;
}

/// Blocks with functions whose support meets that of an active one.
void mark_around(SplineLevel& level, const std::vector<FunctionBox>& boxes) {
  for (FunctionBox box : boxes) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      box.first[axis] -= level.degree;
      box.last[axis] += level.degree;
    }
    for_blocks(level, box.first, box.last, [&](int x, int y, int z) { mark(level, x, y, z); });
  }
}

/// Blocks with functions of which those of the finer level's blocks are part.
void mark_parents(SplineLevel& level, const SplineLevel& finer) {
  constexpr int half = SplineLevel::side / 2;
  for (int z = 0, i = 0; z < finer.blocks_along(2); ++z)
    for (int y = 0; y < finer.blocks_along(1); ++y)
      for (int x = 0; x < finer.blocks_along(0); ++x, ++i)
        if (finer.directory[static_cast<std::size_t>(i)] >= 0)
          for_blocks(level, {half * x - 1, half * y - 1, half * z - 1},
                     {half * x + half - 1, half * y + half - 1, half * z + half - 1},
                     [&](int bx, int by, int bz) { mark(level, bx, by, bz); });
}

void number_blocks(SplineLevel& level) {
  std::size_t i = 0;
  for (std::int32_t z = 0; z < level.blocks_along(2); ++z)
    for (std::int32_t y = 0; y < level.blocks_along(1); ++y)
      for (std::int32_t x = 0; x < level.blocks_along(0); ++x, ++i)
        if (level.directory[i] >= 0) {
          level.directory[i] = static_cast<std::int32_t>(level.blocks.size());
          level.blocks.push_back({x, y, z});
        }
  level.around.resize(level.blocks.size());
  for (std::size_t b = 0; b < level.blocks.size(); ++b) {
    const auto& [x, y, z] = level.blocks[b];
    for (int n = 0; n < 27; ++n)
      level.around[b][static_cast<std::size_t>(n)] = level.find(x + n % 3 - 1, y + n / 3 % 3 - 1, z + n / 9 - 1);
  }
}

void activate_box(SplineLevel& level, const std::array<int, 3>& low, const std::array<int, 3>& high) {
  for_blocks(level, low, high, [&](int bx, int by, int bz) {
    const std::array<int, 3> corner{bx * SplineLevel::side, by * SplineLevel::side, bz * SplineLevel::side};
    char* flags = level.active.data() + static_cast<std::size_t>(level.find(bx, by, bz)) * SplineLevel::block;
    std::array<int, 3> from{}, to{};
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      from[a] = std::max(low[a] - corner[a], 0);
      to[a] = std::min({high[a] - corner[a], SplineLevel::side - 1, level.functions(axis) - 1 - corner[a]});
    }
    for (int z = from[2]; z <= to[2]; ++z)
      for (int y = from[1]; y <= to[1]; ++y)
        for (int x = from[0]; x <= to[0]; ++x) flags[(z * SplineLevel::side + y) * SplineLevel::side + x] = 1;
  });
}

void activate(SplineLevel& level, const std::vector<FunctionBox>& boxes) {
  level.active.assign(level.size(), 0);
  if (level.complete) activate_box(level, {0, 0, 0}, level.cells);
  if (!level.complete)
    for (const FunctionBox& box : boxes) activate_box(level, box.first, box.last);
}

}  // namespace

std::array<int, 3> cell_of(const SplineLevel& level, const Point& p) {
  std::array<int, 3> cell{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<Eigen::Index>(axis);
    const double x = (p[a] - level.origin[a]) / level.spacing;
    cell[axis] = static_cast<int>(std::clamp(std::floor(x), 0.0, level.cells[axis] - 1.0));
  }
  return cell;
}

SplinePosition locate(const SplineLevel& level, const Point& p) {
  assert(p.allFinite());
  SplinePosition at{};
  at.cell = cell_of(level, p);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<Eigen::Index>(axis);
    const double x = (p[a] - level.origin[a]) / level.spacing - at.cell[axis];
    at.values[axis] = spline_values(level.degree, std::clamp(x, 0.0, 1.0));
  }
  return at;
}

double LevelLayout::directory_size() const {
  double size = 1.0;
  for (const int cells : coarsest_cells)
    size *= std::ceil(static_cast<double>(cells) * std::ldexp(1.0, count - 1) / SplineLevel::side);
  return size;
}

LevelLayout lay_out_levels(const Eigen::AlignedBox3d& samples, const LevelOptions& options) {
  constexpr double most_cells = 5.0, least_cells = 4.0;  // of the coarsest level along a side
  const double margin = std::max(options.margin, 3.0 * options.spacing);
  const Eigen::Array3d extent = samples.sizes().array() + 2.0 * margin;
  LevelLayout layout;
  layout.coarsest_spacing = options.spacing;
  while (extent.maxCoeff() > most_cells * layout.coarsest_spacing && layout.count < 30) {
    layout.coarsest_spacing *= 2.0;
    ++layout.count;
  }
  const Eigen::Array3d cells = (extent / layout.coarsest_spacing).ceil().max(least_cells);
  for (std::size_t axis = 0; axis < 3; ++axis)
    layout.coarsest_cells[axis] = static_cast<int>(cells[static_cast<Eigen::Index>(axis)]);
  layout.origin = samples.center() - 0.5 * layout.coarsest_spacing * cells.matrix();
  return layout;
}

std::vector<SplineLevel> build_levels(const LevelLayout& layout, const std::vector<LevelSample>& samples,
                                      const LevelOptions& options) {
  std::vector<SplineLevel> levels(static_cast<std::size_t>(layout.count));
  std::vector<std::vector<FunctionBox>> boxes(levels.size());
  parallel_tasks(levels.size(), [&](std::size_t l) {
    SplineLevel& level = levels[l];
    level.degree = options.degree;
    level.spacing = layout.spacing(static_cast<int>(l));
    level.origin = layout.origin;
    for (std::size_t axis = 0; axis < 3; ++axis) level.cells[axis] = layout.coarsest_cells[axis] << l;
    level.complete = std::ranges::max(level.cells) <= options.complete_cells || l == 0;
    level.directory.assign(level.directory_size(), level.complete ? 0 : -1);
    if (level.complete) return;
    boxes[l] = sampled_boxes(level, static_cast<int>(l), samples);
    mark_around(level, boxes[l]);
  });
  for (std::size_t l = levels.size() - 1; l-- > 0;)
    if (!levels[l].complete) mark_parents(levels[l], levels[l + 1]);
  parallel_tasks(levels.size(), [&](std::size_t l) {
    number_blocks(levels[l]);
    activate(levels[l], boxes[l]);
  });
  for (std::size_t l = 1; l < levels.size(); ++l) levels[l].first = levels[l - 1].first + levels[l - 1].size();
  return levels;
}

}  // namespace rhizodont
