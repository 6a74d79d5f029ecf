// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Interpolation: E. Catmull, R. Rom, "A class of local interpolating splines", 1974.
#include "families/plan_curve.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace rhizodont {

PlanCurve::PlanCurve(const std::vector<Eigen::Vector2d>& places, double beyond) {
  std::vector<Eigen::Vector2d> knots = places;
  const std::size_t n = places.size();
  knots.insert(knots.begin(), places[0] + beyond * (places[0] - places[2]).normalized());
  knots.push_back(places[n - 1] + beyond * (places[n - 1] - places[n - 3]).normalized());
  std::vector<Eigen::Vector2d> dense;
  constexpr int parts = 40;
  for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
    const Eigen::Vector2d &a = knots[i > 0 ? i - 1 : 0], &b = knots[i], &c = knots[i + 1];
    const Eigen::Vector2d& d = knots[std::min(i + 2, knots.size() - 1)];
    const bool end = i == 0 || i + 2 == knots.size();
    for (int k = 0; k < parts; ++k) {
      const double t = static_cast<double>(k) / parts;
      dense.emplace_back(end ? Eigen::Vector2d(b + t * (c - b))
                             : Eigen::Vector2d(0.5 * (2 * b + t * (c - a) + t * t * (2 * a - 5 * b + 4 * c - d) +
                                                      t * t * t * (3 * b - a - 3 * c + d))));
    }
  }
  dense.push_back(knots.back());
  double left = 0;  // to the next point
  for (std::size_t i = 0; i + 1 < dense.size(); ++i) {
    const double edge = (dense[i + 1] - dense[i]).norm();
    for (; left < edge; left += step_) points_.emplace_back(dense[i] + left / edge * (dense[i + 1] - dense[i]));
    left -= edge;
  }
}

Eigen::Vector2d PlanCurve::at(double s) const {
  const double place = std::clamp(s, 0.0, length()) / step_;
  const auto i = std::min(static_cast<std::size_t>(place), points_.size() - 2);
  return points_[i] + (place - static_cast<double>(i)) * (points_[i + 1] - points_[i]);
}

Eigen::Vector2d PlanCurve::tangent(double s) const {
  constexpr double around = 2;
  const double low = std::clamp(s - around, 0.0, length() - 2 * around);
  return (at(low + 2 * around) - at(low)).normalized();
}

double PlanCurve::nearest(const Eigen::Vector2d& p) const {
  std::size_t best = 0;
  for (std::size_t i = 1; i < points_.size(); ++i)
    if ((points_[i] - p).squaredNorm() < (points_[best] - p).squaredNorm()) best = i;
  return step_ * static_cast<double>(best);
}

}  // namespace rhizodont
