// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

namespace rhizodont {

/// Integrals of products of two uniform B-splines with knot spacing 1, by the shift between them. Entry 2 + k belongs
/// to the pair (B(x - i), B(x - i - k)), k = -2..2; degrees 1 and 2 need no more.
struct SplineTables {
  std::array<double, 5> mass;        ///< int B_i B_j
  std::array<double, 5> stiffness;   ///< int B_i' B_j'
  std::array<double, 5> derivative;  ///< int B_i' B_j
  std::array<double, 4> refinement;  ///< B_i of spacing 2 = sum_k refinement[k] B_(2i+k) of spacing 1
};

/// Precondition: degree 1 or 2.
SplineTables spline_tables(int degree);

/// `SplineTables::refinement` as other numbers.
template <class Scalar>
std::array<Scalar, 4> spline_refinement(int degree) {
  if (degree == 1) return {Scalar(0.5), Scalar(1), Scalar(0.5), Scalar(0)};
  return {Scalar(0.25), Scalar(0.75), Scalar(0.75), Scalar(0.25)};
}

/// Values at t in [0, 1] of a cell of the splines that live on it, the one that starts earliest first (degree + 1 of
/// them, the rest 0).
inline std::array<double, 3> spline_values(int degree, double t) {
  if (degree == 1) return {1.0 - t, t, 0.0};
  return {0.5 * (1.0 - t) * (1.0 - t), 0.5 + t * (1.0 - t), 0.5 * t * t};
}

/// Derivatives by t of `spline_values`.
inline std::array<double, 3> spline_derivatives(int degree, double t) {
  if (degree == 1) return {-1.0, 1.0, 0.0};
  return {t - 1.0, 1.0 - 2.0 * t, t};
}

}  // namespace rhizodont
