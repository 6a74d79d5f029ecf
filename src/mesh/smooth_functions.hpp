// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>

namespace rhizodont {

/// 0 before 0, 1 after 1, in between a cubic with level ends.
inline double smooth_step(double x) {
  x = std::clamp(x, 0.0, 1.0);
  return x * x * (3 - 2 * x);
}

/// max(0, x) without a kink: what is within about `width` > 0 of 0 is rounded. Positive everywhere.
inline double soft_plus(double x, double width) {
  const double t = x / width;
  return width * (t > 30 ? t : std::log1p(std::exp(t)));
}

}  // namespace rhizodont
