// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include <vector>

namespace rhizodont {

/// A smooth curve in the plane through given places, going straight on beyond its ends: the line of an arch from above.
class PlanCurve {
 public:
  /// Precondition: >= 3 places, each apart from the next. `beyond` mm are added at either end.
  explicit PlanCurve(const std::vector<Eigen::Vector2d>& places, double beyond = 25);

  double length() const { return step_ * static_cast<double>(points_.size() - 1); }
  /// At a length (mm) along the curve, 0 at its first end; held within the curve.
  Eigen::Vector2d at(double s) const;
  /// Unit.
  Eigen::Vector2d tangent(double s) const;
  /// Length along the curve of its point nearest to p.
  double nearest(const Eigen::Vector2d& p) const;

 private:
  double step_ = 0.25;
  std::vector<Eigen::Vector2d> points_;  // evenly spaced
};

}  // namespace rhizodont
