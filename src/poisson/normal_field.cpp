// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// The smoothed normal field of Poisson reconstruction (Kazhdan, Bolitho and Hoppe 2006). A sample's depth is a real
// number, as in Kazhdan and Hoppe 2013, and the sample is shared between the levels above and below.
#include "poisson/normal_field.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "base/parallel_tasks.hpp"
#include "poisson/bspline.hpp"

namespace rhizodont {
namespace {

using VectorField = std::array<LevelField, 3>;

/// Smears the samples' normals on one level.
void splat(const SplineLevel& level, int number, const OrientedPoints& samples, std::span<const double> shares,
           std::span<const double> depths, VectorField& field) {
  const double volume = level.spacing * level.spacing * level.spacing;
  for (std::size_t s = 0; s < samples.points.size(); ++s) {
    const double part = std::max(0.0, 1.0 - std::abs(depths[s] - number));
    if (!(part > 0.0 && shares[s] > 0.0)) continue;
    const Eigen::Vector3d normal = -part * shares[s] / volume * samples.normals[s];
    for_each_function(level, samples.points[s], [&](std::size_t f, double value) {
      for (std::size_t axis = 0; axis < 3; ++axis)
        field[axis][level.first + f] += value * normal[static_cast<Eigen::Index>(axis)];
    });
  }
}

/// What the smeared normals give the functions of one block: sum over the axes of int dB_i/dx_axis field_axis.
struct Divergence {
  std::array<double, SplineLevel::block> own{};  // of the level's own field
  std::array<double, SplineLevel::block> all{};  // with those of coarser levels
};

Divergence divergence_of_block(const SplineLevel& level, std::size_t block, const VectorField& own,
                               const VectorField& sums) {
  const SplineTables tables = spline_tables(level.degree);
  const std::ptrdiff_t wide = SplineLevel::side + 2 * level.degree, used = wide * wide * wide;
  std::array<double, largest_patch> own_patch, patch;
  Divergence result;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::array<std::array<double, 5>, 3> taps{tables.mass, tables.mass, tables.mass};
    taps[axis] = tables.derivative;
    for (double& tap : taps[0]) tap *= level.spacing * level.spacing;
    gather_patch(level, sums[axis].data() + level.first, block, patch.data());
    add_block_product(level.degree, taps, patch.data(), result.all.data());
    // Most blocks of coarser levels have no samples of their own.
    gather_patch(level, own[axis].data() + level.first, block, own_patch.data());
    if (std::all_of(own_patch.begin(), own_patch.begin() + used, [](double x) { return x == 0.0; })) continue;
    add_block_product(level.degree, taps, own_patch.data(), result.own.data());
  }
  return result;
}

}  // namespace

LevelField normal_load(const std::vector<SplineLevel>& levels, const OrientedPoints& samples,
                       std::span<const double> shares, std::span<const double> depths) {
  VectorField own, sums;
  own.fill(LevelField(field_size(levels), 0.0));
  parallel_tasks(levels.size(),
                 [&](std::size_t l) { splat(levels[l], static_cast<int>(l), samples, shares, depths, own); });
  parallel_tasks(std::size_t{3}, [&](std::size_t axis) { sums[axis] = accumulated(levels, own[axis]); });
  LevelField load(field_size(levels)), outer(field_size(levels));
  for (std::size_t l = levels.size(); l-- > 0;) {
    const SplineLevel& level = levels[l];
    tbb::parallel_for(std::size_t{0}, level.blocks.size(), [&](std::size_t b) {
      std::array<double, SplineLevel::block> of_finer{};
      const std::size_t begin = level.first + b * SplineLevel::block;
      if (l + 1 < levels.size())
        restrict_block(level, b, levels[l + 1], outer.data() + levels[l + 1].first, of_finer.data());
      const Divergence divergence = divergence_of_block(level, b, own, sums);
      for (std::size_t i = 0; i < SplineLevel::block; ++i) {
        outer[begin + i] = of_finer[i] + divergence.own[i];
        load[begin + i] = level.active[b * SplineLevel::block + i] ? of_finer[i] + divergence.all[i] : 0.0;
      }
    });
  }
  return load;
}

}  // namespace rhizodont
