// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Uniform B-splines (de Boor, A Practical Guide to Splines, 1978). The product of two of degree p, integrated over the
// line, is the centred B-spline of degree 2p + 1 at their shift; derivatives of the factors become differences.
#include "poisson/bspline.hpp"

#include <cassert>

namespace rhizodont {
namespace {

/// Centred B-spline of the given degree, by the recursion over degrees.
double centred_spline(int degree, double x) {
  const double half_width = 0.5 * (degree + 1);
  if (x < -half_width || x >= half_width) return 0.0;
  if (degree == 0) return 1.0;
  return ((half_width + x) * centred_spline(degree - 1, x + 0.5) +
          (half_width - x) * centred_spline(degree - 1, x - 0.5)) /
         degree;
}

}  // namespace

SplineTables spline_tables(int degree) {
  assert(degree == 1 || degree == 2);
  SplineTables tables{};
  const int product = 2 * degree + 1;
  for (int k = -2; k <= 2; ++k) {
    const auto entry = static_cast<std::size_t>(k + 2);
    tables.mass[entry] = centred_spline(product, k);
    tables.derivative[entry] = centred_spline(product - 1, k + 0.5) - centred_spline(product - 1, k - 0.5);
    tables.stiffness[entry] =
        2.0 * centred_spline(product - 2, k) - centred_spline(product - 2, k + 1) - centred_spline(product - 2, k - 1);
  }
  tables.refinement = spline_refinement<double>(degree);
  return tables;
}

}  // namespace rhizodont
