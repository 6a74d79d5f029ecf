// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include <utility>
#include <vector>

namespace rhizodont {

/// What a missing unit of a wish counts.
struct WishPrice {
  double square = 4e3;  ///< > 0: of a small lack m: square * m^2
  double most = 40;     ///< > 0: no further unit of a larger lack costs more, which keeps out changes of little use
};

/// A wish that a sum of variables be at least so much.
struct LinearWish {
  std::vector<std::pair<int, double>> terms;  ///< variable, factor; each variable once
  double least = 0;
  WishPrice price = {};
};

/// The cost of a lack m >= 0: square * m^2, going on in a straight line from where its slope reaches `most` (P. Huber,
/// "Robust estimation of a location parameter", 1964).
double price_of(double missing, const WishPrice& price);

/// The x in a box that is smallest for what it leaves of the wishes: it minimises |x|^2 + sum of the prices of what is
/// missing. One multiplier of a wish after the other is set to its best, always in the same order, until nothing moves
/// (C. Hildreth, "A quadratic programming procedure", 1957; a price that goes on straight bounds the multiplier).
/// Variables that no wish names come as near to 0 as the box lets them, exactly.
/// @param low, high  the box, with low <= high; need not hold 0
Eigen::VectorXd least_change(const std::vector<LinearWish>& wishes, const Eigen::VectorXd& low,
                             const Eigen::VectorXd& high);

}  // namespace rhizodont
