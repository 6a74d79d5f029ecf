// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// The smoothed normal field of Poisson reconstruction (Kazhdan, Bolitho and Hoppe 2006), on nested regular grids: a
// sample's depth is a real number, as in Kazhdan and Hoppe 2013, and the sample is shared between the grids above and
// below.
#include "poisson/normal_field.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "poisson/stencils.hpp"

namespace rhizodont {
namespace {

constexpr int smearing_levels = 4;  // cells are a multiple of 2^3, so that so many grids cover the same box

struct Splat {
  SplinePosition at;
  Eigen::Vector3d normal;  // times share over the cell's volume
};

/// How much of each sample goes to each level, as splats sorted by cell.
std::vector<Splat> splats_of_level(const SplineGrid& grid, int level, const OrientedPoints& samples,
                                   std::span<const double> shares, std::span<const double> depths) {
  std::vector<Splat> splats;
  const double volume = grid.spacing * grid.spacing * grid.spacing;
  for (std::size_t s = 0; s < samples.points.size(); ++s) {
    const double part = std::max(0.0, 1.0 - std::abs(depths[s] - level));
    if (part > 0.0 && shares[s] > 0.0)
      splats.push_back({locate(grid, samples.points[s]), -part * shares[s] / volume * samples.normals[s]});
  }
  return splats;
}

void add_splats(const SplineGrid& grid, const std::vector<Splat>& splats, Eigen::Index axis,
                SplineField<double>& field) {
  for (const Splat& splat : splats) {
    const auto& [x, y, z] = splat.at.cell;
    const double normal = splat.normal[axis];
    for (int k = 0; k <= grid.degree; ++k)
      for (int j = 0; j <= grid.degree; ++j) {
        const double factor =
            normal * splat.at.values[2][static_cast<std::size_t>(k)] * splat.at.values[1][static_cast<std::size_t>(j)];
        double* line = field.data() + grid.index(x - grid.degree, y - grid.degree + j, z - grid.degree + k);
        for (std::size_t i = 0; i <= static_cast<std::size_t>(grid.degree); ++i)
          line[i] += factor * splat.at.values[0][i];
      }
  }
}

}  // namespace

double smearing_width(const SplineGrid& grid, double share, double samples_per_cell) {
  const double widest = grid.spacing * (1 << (smearing_levels - 1));
  return std::clamp(std::sqrt(samples_per_cell * share), grid.spacing, widest);
}

void add_normal_load(const SplineGrid& grid, const OrientedPoints& samples, std::span<const double> shares,
                     double samples_per_cell, std::vector<double>& load) {
  std::vector<double> depths(samples.points.size());
  for (std::size_t s = 0; s < depths.size(); ++s)
    depths[s] = std::log2(smearing_width(grid, shares[s], samples_per_cell) / grid.spacing);
  std::vector<SplineGrid> grids{grid};
  for (int level = 1; level < smearing_levels; ++level) grids.push_back(grids.back().coarser());
  std::vector<std::vector<Splat>> splats(grids.size());
  tbb::parallel_for(std::size_t{0}, grids.size(), [&](std::size_t level) {
    splats[level] = splats_of_level(grids[level], static_cast<int>(level), samples, shares, depths);
  });
  std::size_t coarsest = grids.size() - 1;
  while (coarsest > 0 && splats[coarsest].empty()) --coarsest;

  const SplineTables tables = spline_tables(grid.degree);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    SplineField<double> field, coarser;
    for (std::size_t level = coarsest + 1; level-- > 0;) {
      field.assign(grids[level].size(), 0.0);
      if (level < coarsest) add_refined(grids[level], coarser, field);
      add_splats(grids[level], splats[level], static_cast<Eigen::Index>(axis), field);
      std::swap(field, coarser);
    }
    std::array<std::array<double, 5>, 3> taps{tables.mass, tables.mass, tables.mass};
    taps[axis] = tables.derivative;
    add_tensor_product(grid, taps, grid.spacing * grid.spacing, coarser, load);
  }
}

}  // namespace rhizodont
