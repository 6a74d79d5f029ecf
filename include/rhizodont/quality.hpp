// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

namespace rhizodont {

/// The paper's five figures (4.3), and the largest angle.
struct QualityFigures {
  std::size_t triangles = 0;  ///< over which the figures are taken
  double q_avg = 0;  ///< mean of Q = 6 S / (sqrt(3) p h): S area, p half the perimeter, h longest side; 1 = equilateral
  double q_min = 0;
  double theta_avg = 0;         ///< mean over triangles of the smallest angle, degrees
  double theta_min = 0;         ///< smallest angle, degrees
  double theta_max = 0;         ///< largest angle, degrees
  double percent_below_30 = 0;  ///< of all angles, those under 30 degrees, percent
};

}  // namespace rhizodont
