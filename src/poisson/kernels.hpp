// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>

namespace rhizodont {

// Inner loops over one plane of a spline field (`SplineGrid`). Pointers go to the start of a stored plane.

/// Weights of a symmetric stencil of five.
template <class Scalar>
struct SymmetricTaps {
  Scalar centre, next, second;
};

/// Solved-for functions along x and y, and the halo around them.
struct PlaneShape {
  int width;
  int height;
  int halo;
};

/// mass_mass = mass along x and y of u; stiffness_sum = stiffness along x, mass along y, plus the reverse.
/// `scratch`: room for two planes. The halo of the results is left alone.
void stiffness_in_plane(PlaneShape shape, SymmetricTaps<float> mass, SymmetricTaps<float> stiffness, const float* u,
                        float* scratch, float* mass_mass, float* stiffness_sum);
void stiffness_in_plane(PlaneShape shape, SymmetricTaps<double> mass, SymmetricTaps<double> stiffness, const double* u,
                        double* scratch, double* mass_mass, double* stiffness_sum);

/// out = stiffness across planes of mass_mass + mass across planes of stiffness_sum; `plane` = distance of planes.
void stiffness_across_planes(PlaneShape shape, SymmetricTaps<float> mass, SymmetricTaps<float> stiffness,
                             const float* mass_mass, const float* stiffness_sum, std::size_t plane, float* out);
void stiffness_across_planes(PlaneShape shape, SymmetricTaps<double> mass, SymmetricTaps<double> stiffness,
                             const double* mass_mass, const double* stiffness_sum, std::size_t plane, double* out);

/// out = stencils along x and y of u. `scratch`: room for one plane.
void product_in_plane(PlaneShape shape, const std::array<double, 5>& taps_x, const std::array<double, 5>& taps_y,
                      const double* u, double* scratch, double* out);

/// out += stencil across planes of u.
void add_across_planes(PlaneShape shape, const std::array<double, 5>& taps_z, const double* u, std::size_t plane,
                       double* out);

/// One Chebyshev step on `count` entries: r -= change (if `change`), d = keep d + step inverse_diagonal r, x += d.
void chebyshev_step(std::size_t count, float keep, float step, const float* inverse_diagonal, const float* change,
                    float* r, float* d, float* x);

}  // namespace rhizodont
