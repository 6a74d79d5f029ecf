// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

#include <cmath>
#include <limits>

namespace rhizodont {

/// The float nearest to x, as a double.
/// Precondition: |x| is at most the largest float.
/// g++ 12 with -ftree-slp-vectorize (part of -O2) takes the conversion to float and back for no change where two such
/// conversions stand side by side, also inside Eigen's cast<float>().cast<double>(). The volatile keeps it from that.
inline double nearest_float(double x) {
  const volatile float rounded = static_cast<float>(x);
  return static_cast<double>(rounded);
}

/// True if x is a float (NaN and infinity are not).
inline bool is_float(double x) {
  return std::abs(x) <= static_cast<double>(std::numeric_limits<float>::max()) && nearest_float(x) == x;
}

/// Each coordinate rounded to the nearest float.
inline Point nearest_float(const Point& p) {
  return {nearest_float(p.x()), nearest_float(p.y()), nearest_float(p.z())};
}

}  // namespace rhizodont
