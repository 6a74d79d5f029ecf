// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include <utility>
#include <vector>

namespace rhizodont {

/// A wish that a sum of variables be at least so much.
struct LinearWish {
  std::vector<std::pair<int, double>> terms;  ///< variable, factor; each variable once
  double least = 0;
};

/// The x in a box that is smallest for what it leaves of the wishes: it minimises |x|^2 + weight * sum of the squares
/// of what is missing. Newton's method in the box: D. Bertsekas, "Projected Newton methods for optimization problems
/// with simple constraints", 1982. Variables that no wish names come as near to 0 as the box lets them, exactly.
/// @param low, high  the box, with low <= high; need not hold 0
/// @param weight     > 0
Eigen::VectorXd least_change(const std::vector<LinearWish>& wishes, const Eigen::VectorXd& low,
                             const Eigen::VectorXd& high, double weight);

}  // namespace rhizodont
