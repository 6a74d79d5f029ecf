// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>

namespace rhizodont {

// Inner loops over one block of 8 x 8 x 8 spline coefficients. A patch is a block with `halo` = degree coefficients
// around it, (8 + 2 halo)^3 of them, x fastest.

inline constexpr std::size_t largest_patch = 12 * 12 * 12;

/// Weights of a symmetric stencil of 2 halo + 1 along one axis.
template <class Scalar>
struct SymmetricTaps {
  Scalar centre, next, second;
};

/// out[512] = (K M M + M K M + M M K) patch, by axes x, y, z.
void block_stiffness(int halo, SymmetricTaps<float> mass, SymmetricTaps<float> stiffness, const float* patch,
                     float* out);
void block_stiffness(int halo, SymmetricTaps<double> mass, SymmetricTaps<double> stiffness, const double* patch,
                     double* out);

/// out[512] += (X Y Z) patch with the taps of each axis, the first of which belongs to the coefficient 2 below.
void add_block_product(int halo, const std::array<std::array<double, 5>, 3>& taps, const double* patch, double* out);

/// The patch of a block from it and the 26 around it, x fastest; absent ones (null) count as zero.
void join_blocks(int halo, const std::array<const float*, 27>& blocks, float* patch);
void join_blocks(int halo, const std::array<const double*, 27>& blocks, double* patch);

/// out[512]: each coefficient the sum of refinement[k] fine(2 i + k), from the 3^3 finer blocks that begin at twice the
/// block's corner; absent ones (null) count as zero.
void block_restriction(const std::array<float, 4>& refinement, const std::array<const float*, 27>& fine, float* out);
void block_restriction(const std::array<double, 4>& refinement, const std::array<const double*, 27>& fine, double* out);

/// out[512]: the finer coefficients of a block from the 5^3 coarser ones of which they are part.
void block_prolongation(const std::array<float, 4>& refinement, const float* coarse, float* out);
void block_prolongation(const std::array<double, 4>& refinement, const double* coarse, double* out);

/// One Chebyshev step on 512 entries: r -= product, d_new = keep d + step inverse_bound r, x += d_new.
void chebyshev_step(float keep, float step, const float* inverse_bound, const float* product, const float* d, float* r,
                    float* d_new, float* x);

}  // namespace rhizodont
