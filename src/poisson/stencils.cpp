// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Stiffness of tensor-product B-splines, applied axis by axis: with M and K the one-dimensional mass and stiffness,
// A = K(x)M(x)M + M(x)K(x)M + M(x)M(x)K. Planes are the unit of work; each is computed alike by whichever thread.
#include "poisson/stencils.hpp"

#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "poisson/kernels.hpp"

namespace rhizodont {
namespace {

/// The largest value over all frequencies of the symbol of the infinite Toeplitz operator, which bounds the eigenvalues
/// of every finite section; from a grid of frequencies, with a little to spare.
double largest_symbol(const SplineTables& tables) {
  constexpr int steps = 32;
  std::array<double, steps + 1> mass{}, stiffness{};
  for (std::size_t i = 0; i <= steps; ++i) {
    const double angle = std::numbers::pi * static_cast<double>(i) / steps;
    mass[i] = tables.mass[2] + 2.0 * (tables.mass[3] * std::cos(angle) + tables.mass[4] * std::cos(2.0 * angle));
    stiffness[i] = tables.stiffness[2] +
                   2.0 * (tables.stiffness[3] * std::cos(angle) + tables.stiffness[4] * std::cos(2.0 * angle));
  }
  double largest = 0.0;
  for (std::size_t x = 0; x <= steps; ++x)
    for (std::size_t y = 0; y <= x; ++y)
      for (std::size_t z = 0; z <= y; ++z)
        largest = std::max(largest, stiffness[x] * mass[y] * mass[z] + mass[x] * stiffness[y] * mass[z] +
                                        mass[x] * mass[y] * stiffness[z]);
  return 1.02 * largest;
}

template <class Scalar>
SymmetricTaps<Scalar> half_taps(const std::array<double, 5>& taps, double scale) {
  return {static_cast<Scalar>(scale * taps[2]), static_cast<Scalar>(scale * taps[3]),
          static_cast<Scalar>(scale * taps[4])};
}

}  // namespace

template <class Scalar>
LaplaceStencil<Scalar>::LaplaceStencil(const SplineGrid& grid)
    : grid_(grid),
      tables_(spline_tables(grid.degree)),
      largest_eigenvalue_(grid.spacing * largest_symbol(tables_)),
      mass_mass_(grid.size(), Scalar(0)),
      stiffness_sum_(grid.size(), Scalar(0)) {}

template <class Scalar>
void LaplaceStencil<Scalar>::apply(const std::vector<Scalar>& u, std::vector<Scalar>& out) {
  const PlaneShape shape{grid_.functions(0), grid_.functions(1), SplineGrid::halo};
  const std::size_t plane = grid_.plane();
  const auto first = static_cast<std::size_t>(SplineGrid::halo);
  const std::size_t end = first + static_cast<std::size_t>(grid_.functions(2));
  const auto mass = half_taps<Scalar>(tables_.mass, 1.0), stiffness = half_taps<Scalar>(tables_.stiffness, 1.0);
  tbb::enumerable_thread_specific<std::vector<Scalar>> scratch(
      [&] { return std::vector<Scalar>(2 * static_cast<std::size_t>(grid_.stored(1)) * grid_.row()); });
  tbb::parallel_for(first, end, [&](std::size_t z) {
    stiffness_in_plane(shape, mass, stiffness, u.data() + z * plane, scratch.local().data(),
                       mass_mass_.data() + z * plane, stiffness_sum_.data() + z * plane);
  });
  const auto mass_z = half_taps<Scalar>(tables_.mass, grid_.spacing);
  const auto stiffness_z = half_taps<Scalar>(tables_.stiffness, grid_.spacing);
  tbb::parallel_for(first, end, [&](std::size_t z) {
    stiffness_across_planes(shape, mass_z, stiffness_z, mass_mass_.data() + z * plane,
                            stiffness_sum_.data() + z * plane, plane, out.data() + z * plane);
  });
}

template class LaplaceStencil<float>;
template class LaplaceStencil<double>;

template <class Scalar>
void restrict_field(const SplineGrid& grid, const std::vector<Scalar>& fine, std::vector<Scalar>& coarse) {
  const SplineGrid parent = grid.coarser();
  std::array<Scalar, 4> refinement;
  std::ranges::transform(spline_tables(grid.degree).refinement, refinement.begin(),
                         [](double r) { return static_cast<Scalar>(r); });
  const auto fine_row = static_cast<std::size_t>(grid.functions(0) + SplineGrid::halo);
  tbb::parallel_for(0, parent.functions(2), [&](int z) {
    std::vector<Scalar> line(fine_row + 2);
    for (int y = 0; y < parent.functions(1); ++y) {
      std::fill(line.begin(), line.end(), Scalar(0));
      for (int k = 0; k <= grid.degree + 1; ++k)
        for (int j = 0; j <= grid.degree + 1; ++j) {
          const Scalar factor = refinement[static_cast<std::size_t>(k)] * refinement[static_cast<std::size_t>(j)];
          const Scalar* source = fine.data() + grid.index(0, 2 * y + j, 2 * z + k);
          for (std::size_t x = 0; x < fine_row; ++x) line[x] += factor * source[x];
        }
      Scalar* target = coarse.data() + parent.index(0, y, z);
      for (std::size_t x = 0; x < static_cast<std::size_t>(parent.functions(0)); ++x)
        target[x] = refinement[0] * line[2 * x] + refinement[1] * line[2 * x + 1] + refinement[2] * line[2 * x + 2] +
                    refinement[3] * line[2 * x + 3];
    }
  });
}

template <class Scalar>
void prolong_add(const SplineGrid& grid, const std::vector<Scalar>& coarse, std::vector<Scalar>& fine) {
  const SplineGrid parent = grid.coarser();
  std::array<Scalar, 4> refinement;
  std::ranges::transform(spline_tables(grid.degree).refinement, refinement.begin(),
                         [](double r) { return static_cast<Scalar>(r); });
  const auto width = static_cast<std::size_t>(grid.functions(0));
  tbb::parallel_for(0, grid.functions(2), [&](int z) {
    std::vector<Scalar> line(width / 2 + 2);  // coarse functions -1 .. width / 2, as far as a fine row reaches
    for (int y = 0; y < grid.functions(1); ++y) {
      std::fill(line.begin(), line.end(), Scalar(0));
      for (int k = z / 2 - 1; k <= z / 2; ++k)
        for (int j = y / 2 - 1; j <= y / 2; ++j) {
          const Scalar factor =
              refinement[static_cast<std::size_t>(z - 2 * k)] * refinement[static_cast<std::size_t>(y - 2 * j)];
          const Scalar* source = coarse.data() + parent.index(-1, j, k);
          for (std::size_t x = 0; x < line.size(); ++x) line[x] += factor * source[x];
        }
      Scalar* target = fine.data() + grid.index(0, y, z);
      for (std::size_t x = 0; x < width; ++x)
        target[x] += refinement[x % 2] * line[x / 2 + 1] + refinement[x % 2 + 2] * line[x / 2];
    }
  });
}

template void restrict_field(const SplineGrid&, const std::vector<float>&, std::vector<float>&);
template void restrict_field(const SplineGrid&, const std::vector<double>&, std::vector<double>&);
template void prolong_add(const SplineGrid&, const std::vector<float>&, std::vector<float>&);
template void prolong_add(const SplineGrid&, const std::vector<double>&, std::vector<double>&);

void add_tensor_product(const SplineGrid& grid, const std::array<std::array<double, 5>, 3>& taps, double scale,
                        const std::vector<double>& field, std::vector<double>& out) {
  const PlaneShape shape{grid.functions(0), grid.functions(1), SplineGrid::halo};
  const std::size_t plane = grid.plane();
  std::vector<double> in_plane(grid.size(), 0.0);
  tbb::parallel_for(std::size_t{0}, static_cast<std::size_t>(grid.stored(2)), [&](std::size_t z) {
    std::vector<double> scratch(plane);
    product_in_plane(shape, taps[0], taps[1], field.data() + z * plane, scratch.data(), in_plane.data() + z * plane);
  });
  std::array<double, 5> taps_z = taps[2];
  for (double& tap : taps_z) tap *= scale;
  const auto first = static_cast<std::size_t>(SplineGrid::halo);
  tbb::parallel_for(first, first + static_cast<std::size_t>(grid.functions(2)), [&](std::size_t z) {
    add_across_planes(shape, taps_z, in_plane.data() + z * plane, plane, out.data() + z * plane);
  });
}

}  // namespace rhizodont
