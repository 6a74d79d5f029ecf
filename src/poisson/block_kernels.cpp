// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// The loops in which nearly all time of the Poisson solver goes. The file is compiled for loop vectorisation, and on
// x86 for two instruction sets, of which the program picks one at start; both do the same operations in the same order.
#include "poisson/block_kernels.hpp"

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define RHIZODONT_VECTOR_CLONES __attribute__((target_clones("avx2", "default")))
#else
#define RHIZODONT_VECTOR_CLONES
#endif
#define RHIZODONT_INLINE [[gnu::always_inline]] inline

namespace rhizodont {
namespace {

constexpr int side = 8;

template <int halo, class Scalar>
RHIZODONT_INLINE Scalar tapped(const Scalar* at, int stride, const SymmetricTaps<Scalar>& taps) {
  Scalar sum = taps.centre * at[0] + taps.next * (at[-stride] + at[stride]);
  if constexpr (halo == 2) sum += taps.second * (at[-2 * stride] + at[2 * stride]);
  return sum;
}

template <int halo, class Scalar>
RHIZODONT_INLINE void stiffness(const SymmetricTaps<Scalar>& mass, const SymmetricTaps<Scalar>& stiff,
                                const Scalar* __restrict patch, Scalar* __restrict out) {
  constexpr int wide = side + 2 * halo, plane = side * side;
  Scalar mass_x[wide * side], stiff_x[wide * side];
  Scalar mass_mass[wide * plane], stiffness_sum[wide * plane];
  for (int z = 0; z < wide; ++z) {
    for (int y = 0; y < wide; ++y) {
      const Scalar* row = patch + (z * wide + y) * wide + halo;
      for (int x = 0; x < side; ++x) mass_x[y * side + x] = tapped<halo>(row + x, 1, mass);
      for (int x = 0; x < side; ++x) stiff_x[y * side + x] = tapped<halo>(row + x, 1, stiff);
    }
    for (int i = 0; i < plane; ++i) {
      const Scalar* m = mass_x + halo * side + i;
      mass_mass[z * plane + i] = tapped<halo>(m, side, mass);
      stiffness_sum[z * plane + i] = tapped<halo>(m, side, stiff) + tapped<halo>(stiff_x + halo * side + i, side, mass);
    }
  }
  for (int i = 0; i < side * plane; ++i)
    out[i] = tapped<halo>(mass_mass + halo * plane + i, plane, stiff) +
             tapped<halo>(stiffness_sum + halo * plane + i, plane, mass);
}

template <int halo>
RHIZODONT_INLINE void product(const std::array<std::array<double, 5>, 3>& taps, const double* __restrict patch,
                              double* __restrict out) {
  constexpr int wide = side + 2 * halo, plane = side * side;
  double along_x[wide * side], along_xy[wide * plane];
  for (int z = 0; z < wide; ++z) {
    for (int y = 0; y < wide; ++y) {
      const double* row = patch + (z * wide + y) * wide + halo;
      for (int x = 0; x < side; ++x) {
        double sum = 0.0;
        for (int k = -halo; k <= halo; ++k) sum += taps[0][static_cast<std::size_t>(k + 2)] * row[x + k];
        along_x[y * side + x] = sum;
      }
    }
    for (int i = 0; i < plane; ++i) {
      double sum = 0.0;
      for (int k = -halo; k <= halo; ++k)
        sum += taps[1][static_cast<std::size_t>(k + 2)] * along_x[(halo + k) * side + i];
      along_xy[z * plane + i] = sum;
    }
  }
  for (int i = 0; i < side * plane; ++i) {
    double sum = 0.0;
    for (int k = -halo; k <= halo; ++k)
      sum += taps[2][static_cast<std::size_t>(k + 2)] * along_xy[(halo + k) * plane + i];
    out[i] += sum;
  }
}

template <class Scalar>
constexpr Scalar zeros[side * side * side] = {};

template <class Scalar>
RHIZODONT_INLINE const Scalar* or_zeros(const Scalar* block) {
  return block == nullptr ? zeros<Scalar> : block;
}

template <int halo, class Scalar>
RHIZODONT_INLINE void join(const std::array<const Scalar*, 27>& blocks, Scalar* __restrict patch) {
  constexpr int wide = side + 2 * halo;
  for (int z = -halo; z < side + halo; ++z)
    for (int y = -halo; y < side + halo; ++y) {
      const int bz = z < 0 ? 0 : z < side ? 1 : 2, by = y < 0 ? 0 : y < side ? 1 : 2;
      const auto b = static_cast<std::size_t>(9 * bz + 3 * by);
      const int row = ((z + side) % side * side + (y + side) % side) * side;
      const Scalar* before = or_zeros(blocks[b]) + row + side - halo;
      const Scalar* here = or_zeros(blocks[b + 1]) + row;
      const Scalar* after = or_zeros(blocks[b + 2]) + row;
      for (int x = 0; x < halo; ++x) patch[x] = before[x];
      for (int x = 0; x < side; ++x) patch[halo + x] = here[x];
      for (int x = 0; x < halo; ++x) patch[halo + side + x] = after[x];
      patch += wide;
    }
}

template <class Scalar>
RHIZODONT_INLINE void restriction(const std::array<Scalar, 4>& r, const std::array<const Scalar*, 27>& fine,
                                  Scalar* __restrict out) {
  constexpr int wide = 2 * side + 2;
  Scalar along_x[wide * wide * side], along_xy[wide * side * side];
  for (int z = 0; z < wide; ++z)
    for (int y = 0; y < wide; ++y) {
      const auto b = static_cast<std::size_t>(9 * (z / side) + 3 * (y / side));
      const int from = (z % side * side + y % side) * side;
      Scalar at[wide];
      for (int x = 0; x < side; ++x) at[x] = or_zeros(fine[b])[from + x];
      for (int x = 0; x < side; ++x) at[side + x] = or_zeros(fine[b + 1])[from + x];
      for (int x = 0; x < 2; ++x) at[2 * side + x] = or_zeros(fine[b + 2])[from + x];
      for (int x = 0; x < side; ++x)
        along_x[(z * wide + y) * side + x] =
            r[0] * at[2 * x] + r[1] * at[2 * x + 1] + r[2] * at[2 * x + 2] + r[3] * at[2 * x + 3];
    }
  for (int z = 0; z < wide; ++z)
    for (int y = 0; y < side; ++y) {
      const Scalar* at = along_x + (z * wide + 2 * y) * side;
      for (int x = 0; x < side; ++x)
        along_xy[(z * side + y) * side + x] =
            r[0] * at[x] + r[1] * at[side + x] + r[2] * at[2 * side + x] + r[3] * at[3 * side + x];
    }
  constexpr int plane = side * side;
  for (int z = 0; z < side; ++z) {
    const Scalar* at = along_xy + 2 * z * plane;
    for (int i = 0; i < plane; ++i)
      out[z * plane + i] = r[0] * at[i] + r[1] * at[plane + i] + r[2] * at[2 * plane + i] + r[3] * at[3 * plane + i];
  }
}

template <class Scalar>
RHIZODONT_INLINE void prolongation(const std::array<Scalar, 4>& r, const Scalar* __restrict coarse,
                                   Scalar* __restrict out) {
  constexpr int few = side / 2 + 1, plane = side * side;
  Scalar along_x[few * few * side], along_xy[few * plane];
  for (int row = 0; row < few * few; ++row)
    for (int m = 0; m < side / 2; ++m) {
      const Scalar lower = coarse[row * few + m], upper = coarse[row * few + m + 1];
      along_x[row * side + 2 * m] = r[0] * upper + r[2] * lower;
      along_x[row * side + 2 * m + 1] = r[1] * upper + r[3] * lower;
    }
  for (int z = 0; z < few; ++z)
    for (int m = 0; m < side / 2; ++m) {
      const Scalar* lower = along_x + (z * few + m) * side;
      Scalar* to = along_xy + (z * side + 2 * m) * side;
      for (int x = 0; x < side; ++x) to[x] = r[0] * lower[side + x] + r[2] * lower[x];
      for (int x = 0; x < side; ++x) to[side + x] = r[1] * lower[side + x] + r[3] * lower[x];
    }
  for (int m = 0; m < side / 2; ++m) {
    const Scalar* lower = along_xy + m * plane;
    Scalar* to = out + 2 * m * plane;
    for (int i = 0; i < plane; ++i) to[i] = r[0] * lower[plane + i] + r[2] * lower[i];
    for (int i = 0; i < plane; ++i) to[plane + i] = r[1] * lower[plane + i] + r[3] * lower[i];
  }
}

}  // namespace

RHIZODONT_VECTOR_CLONES void block_stiffness(int halo, SymmetricTaps<float> mass, SymmetricTaps<float> stiff,
                                             const float* patch, float* out) {
  halo == 2 ? stiffness<2>(mass, stiff, patch, out) : stiffness<1>(mass, stiff, patch, out);
}

RHIZODONT_VECTOR_CLONES void block_stiffness(int halo, SymmetricTaps<double> mass, SymmetricTaps<double> stiff,
                                             const double* patch, double* out) {
  halo == 2 ? stiffness<2>(mass, stiff, patch, out) : stiffness<1>(mass, stiff, patch, out);
}

RHIZODONT_VECTOR_CLONES void add_block_product(int halo, const std::array<std::array<double, 5>, 3>& taps,
                                               const double* patch, double* out) {
  halo == 2 ? product<2>(taps, patch, out) : product<1>(taps, patch, out);
}

RHIZODONT_VECTOR_CLONES void join_blocks(int halo, const std::array<const float*, 27>& blocks, float* patch) {
  halo == 2 ? join<2>(blocks, patch) : join<1>(blocks, patch);
}

RHIZODONT_VECTOR_CLONES void join_blocks(int halo, const std::array<const double*, 27>& blocks, double* patch) {
  halo == 2 ? join<2>(blocks, patch) : join<1>(blocks, patch);
}

RHIZODONT_VECTOR_CLONES void block_restriction(const std::array<float, 4>& refinement,
                                               const std::array<const float*, 27>& fine, float* out) {
  restriction(refinement, fine, out);
}

RHIZODONT_VECTOR_CLONES void block_restriction(const std::array<double, 4>& refinement,
                                               const std::array<const double*, 27>& fine, double* out) {
  restriction(refinement, fine, out);
}

RHIZODONT_VECTOR_CLONES void block_prolongation(const std::array<float, 4>& refinement, const float* coarse,
                                                float* out) {
  prolongation(refinement, coarse, out);
}

RHIZODONT_VECTOR_CLONES void block_prolongation(const std::array<double, 4>& refinement, const double* coarse,
                                                double* out) {
  prolongation(refinement, coarse, out);
}

RHIZODONT_VECTOR_CLONES void chebyshev_step(float keep, float step, const float* __restrict inverse_bound,
                                            const float* __restrict product_d, const float* __restrict d,
                                            float* __restrict r, float* __restrict d_new, float* __restrict x) {
  for (int i = 0; i < side * side * side; ++i) {
    r[i] -= product_d[i];
    d_new[i] = keep * d[i] + step * inverse_bound[i] * r[i];
    x[i] += d_new[i];
  }
}

}  // namespace rhizodont
