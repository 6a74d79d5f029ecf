// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// The loops in which nearly all time of the Poisson solver goes. The file is compiled for loop vectorisation, and on
// x86 for two instruction sets, of which the program picks one at start; both do the same operations in the same order.
#include "poisson/kernels.hpp"

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define RHIZODONT_VECTOR_CLONES __attribute__((target_clones("avx2", "default")))
#else
#define RHIZODONT_VECTOR_CLONES
#endif

namespace rhizodont {
namespace {

template <class Scalar>
[[gnu::always_inline]] inline void in_plane(PlaneShape shape, SymmetricTaps<Scalar> mass,
                                            SymmetricTaps<Scalar> stiffness, const Scalar* __restrict u,
                                            Scalar* __restrict mass_x, Scalar* __restrict stiffness_x,
                                            Scalar* __restrict mass_mass, Scalar* __restrict stiffness_sum) {
  const std::ptrdiff_t width = shape.width, height = shape.height, halo = shape.halo;
  const std::ptrdiff_t row = width + 2 * halo;
  for (std::ptrdiff_t y = 0; y < height + 2 * halo; ++y) {
    const Scalar* line = u + y * row + halo;
    for (std::ptrdiff_t x = 0; x < width; ++x) {
      const Scalar centre = line[x], next = line[x - 1] + line[x + 1], second = line[x - 2] + line[x + 2];
      mass_x[y * row + x] = mass.centre * centre + mass.next * next + mass.second * second;
      stiffness_x[y * row + x] = stiffness.centre * centre + stiffness.next * next + stiffness.second * second;
    }
  }
  for (std::ptrdiff_t y = halo; y < height + halo; ++y) {
    const Scalar* m = mass_x + y * row;
    const Scalar* k = stiffness_x + y * row;
    for (std::ptrdiff_t x = 0; x < width; ++x) {
      const Scalar m0 = m[x], m1 = m[x - row] + m[x + row], m2 = m[x - 2 * row] + m[x + 2 * row];
      const Scalar k0 = k[x], k1 = k[x - row] + k[x + row], k2 = k[x - 2 * row] + k[x + 2 * row];
      mass_mass[y * row + halo + x] = mass.centre * m0 + mass.next * m1 + mass.second * m2;
      stiffness_sum[y * row + halo + x] = (stiffness.centre * m0 + stiffness.next * m1 + stiffness.second * m2) +
                                          (mass.centre * k0 + mass.next * k1 + mass.second * k2);
    }
  }
}

template <class Scalar>
[[gnu::always_inline]] inline void across_planes(PlaneShape shape, SymmetricTaps<Scalar> mass,
                                                 SymmetricTaps<Scalar> stiffness, const Scalar* __restrict m,
                                                 const Scalar* __restrict k, std::ptrdiff_t plane,
                                                 Scalar* __restrict out) {
  const std::ptrdiff_t row = shape.width + 2 * shape.halo;
  for (std::ptrdiff_t y = shape.halo; y < shape.height + shape.halo; ++y) {
    const std::ptrdiff_t begin = y * row + shape.halo, end = begin + shape.width;
    for (std::ptrdiff_t i = begin; i < end; ++i) {
      const Scalar m1 = m[i - plane] + m[i + plane], m2 = m[i - 2 * plane] + m[i + 2 * plane];
      const Scalar k1 = k[i - plane] + k[i + plane], k2 = k[i - 2 * plane] + k[i + 2 * plane];
      out[i] = (stiffness.centre * m[i] + stiffness.next * m1 + stiffness.second * m2) +
               (mass.centre * k[i] + mass.next * k1 + mass.second * k2);
    }
  }
}

}  // namespace

RHIZODONT_VECTOR_CLONES void stiffness_in_plane(PlaneShape shape, SymmetricTaps<float> mass,
                                                SymmetricTaps<float> stiffness, const float* u, float* scratch,
                                                float* mass_mass, float* stiffness_sum) {
  float* second_half = scratch + (shape.width + 2 * shape.halo) * (shape.height + 2 * shape.halo);
  in_plane(shape, mass, stiffness, u, scratch, second_half, mass_mass, stiffness_sum);
}

RHIZODONT_VECTOR_CLONES void stiffness_in_plane(PlaneShape shape, SymmetricTaps<double> mass,
                                                SymmetricTaps<double> stiffness, const double* u, double* scratch,
                                                double* mass_mass, double* stiffness_sum) {
  double* second_half = scratch + (shape.width + 2 * shape.halo) * (shape.height + 2 * shape.halo);
  in_plane(shape, mass, stiffness, u, scratch, second_half, mass_mass, stiffness_sum);
}

RHIZODONT_VECTOR_CLONES void stiffness_across_planes(PlaneShape shape, SymmetricTaps<float> mass,
                                                     SymmetricTaps<float> stiffness, const float* mass_mass,
                                                     const float* stiffness_sum, std::size_t plane, float* out) {
  across_planes(shape, mass, stiffness, mass_mass, stiffness_sum, static_cast<std::ptrdiff_t>(plane), out);
}

RHIZODONT_VECTOR_CLONES void stiffness_across_planes(PlaneShape shape, SymmetricTaps<double> mass,
                                                     SymmetricTaps<double> stiffness, const double* mass_mass,
                                                     const double* stiffness_sum, std::size_t plane, double* out) {
  across_planes(shape, mass, stiffness, mass_mass, stiffness_sum, static_cast<std::ptrdiff_t>(plane), out);
}

RHIZODONT_VECTOR_CLONES void product_in_plane(PlaneShape shape, const std::array<double, 5>& taps_x,
                                              const std::array<double, 5>& taps_y, const double* u, double* scratch,
                                              double* out) {
  const std::ptrdiff_t width = shape.width, height = shape.height, halo = shape.halo;
  const std::ptrdiff_t row = width + 2 * halo;
  for (std::ptrdiff_t y = 0; y < height + 2 * halo; ++y)
    for (std::ptrdiff_t x = 0; x < width; ++x) {
      const double* at = u + y * row + halo + x;
      scratch[y * row + x] =
          taps_x[0] * at[-2] + taps_x[1] * at[-1] + taps_x[2] * at[0] + taps_x[3] * at[1] + taps_x[4] * at[2];
    }
  for (std::ptrdiff_t y = halo; y < height + halo; ++y)
    for (std::ptrdiff_t x = 0; x < width; ++x) {
      const double* at = scratch + y * row + x;
      out[y * row + halo + x] = taps_y[0] * at[-2 * row] + taps_y[1] * at[-row] + taps_y[2] * at[0] +
                                taps_y[3] * at[row] + taps_y[4] * at[2 * row];
    }
}

RHIZODONT_VECTOR_CLONES void add_across_planes(PlaneShape shape, const std::array<double, 5>& taps_z, const double* u,
                                               std::size_t plane, double* out) {
  const std::ptrdiff_t step = static_cast<std::ptrdiff_t>(plane), row = shape.width + 2 * shape.halo;
  for (std::ptrdiff_t y = shape.halo; y < shape.height + shape.halo; ++y)
    for (std::ptrdiff_t i = y * row + shape.halo; i < y * row + shape.halo + shape.width; ++i)
      out[i] += taps_z[0] * u[i - 2 * step] + taps_z[1] * u[i - step] + taps_z[2] * u[i] + taps_z[3] * u[i + step] +
                taps_z[4] * u[i + 2 * step];
}

RHIZODONT_VECTOR_CLONES void chebyshev_step(std::size_t count, float keep, float step,
                                            const float* __restrict inverse_diagonal, const float* __restrict change,
                                            float* __restrict r, float* __restrict d, float* __restrict x) {
  if (change != nullptr)
    for (std::size_t i = 0; i < count; ++i) r[i] -= change[i];
  for (std::size_t i = 0; i < count; ++i) {
    d[i] = keep * d[i] + step * inverse_diagonal[i] * r[i];
    x[i] += d[i];
  }
}

}  // namespace rhizodont
