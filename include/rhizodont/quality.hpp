// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>

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

/// Figures over the triangles that are not the crown's, and over two parts of them.
struct NewTriangleFigures {
  std::optional<QualityFigures> all;
  std::optional<QualityFigures> inner;      ///< those that touch no crown vertex
  std::optional<QualityFigures> at_border;  ///< those that touch one: the crown's border sets them a limit

  static constexpr double least_q_avg = 0.93;           ///< of all
  static constexpr double most_percent_below_30 = 0.5;  ///< of all
  static constexpr double least_inner_angle = 20;       ///< degrees
  static constexpr double least_border_angle = 5;       ///< degrees

  /// Promise 3: all of these bounds are kept.
  bool holds() const {
    return all && all->q_avg >= least_q_avg && all->percent_below_30 <= most_percent_below_30 &&
           (!inner || inner->theta_min >= least_inner_angle) &&
           (!at_border || at_border->theta_min >= least_border_angle);
  }
};

}  // namespace rhizodont
