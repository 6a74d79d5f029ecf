// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "arch/least_change.hpp"

#include <algorithm>
#include <cmath>

namespace rhizodont {
namespace {

/// What pushes the variables away from 0, kept up to date in x: a multiplier per wish, times its factors, and per
/// variable what the sides of the box push.
struct Multipliers {
  std::vector<double> of_wishes, squares;
  Eigen::VectorXd x, up, down;

  /// Sets the multiplier of one wish to its best. Returns how far x moves.
  double settle(std::size_t k, const LinearWish& wish) {
    if (squares[k] == 0) return 0;
    double missing = wish.least - of_wishes[k] / wish.price.square;
    for (const auto& [variable, factor] : wish.terms) missing -= factor * x[variable];
    const double best = of_wishes[k] + missing / (squares[k] + 1 / wish.price.square);
    const double more = std::clamp(best, 0.0, 0.5 * wish.price.most) - of_wishes[k];
    of_wishes[k] += more;
    for (const auto& [variable, factor] : wish.terms) x[variable] += more * factor;
    return std::abs(more) * std::sqrt(squares[k]);
  }

  double settle_sides(Eigen::Index i, double low, double high) {
    const double before = x[i];
    const double pushed_up = std::max(0.0, up[i] + low - x[i]);
    x[i] += pushed_up - up[i];
    up[i] = pushed_up;
    const double pushed_down = std::max(0.0, down[i] + x[i] - high);
    x[i] -= pushed_down - down[i];
    down[i] = pushed_down;
    return std::abs(x[i] - before);
  }
};

}  // namespace

double price_of(double missing, const WishPrice& price) {
  const double bend = 0.5 * price.most / price.square;
  if (missing <= bend) return price.square * missing * missing;
  return price.most * (missing - 0.5 * bend);
}

Eigen::VectorXd least_change(const std::vector<LinearWish>& wishes, const Eigen::VectorXd& low,
                             const Eigen::VectorXd& high) {
  constexpr int sweeps = 5000;
  constexpr double still = 1e-9;
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(low.size());
  Multipliers multipliers{std::vector<double>(wishes.size(), 0), std::vector<double>(wishes.size(), 0), zero, zero,
                          zero};
  for (std::size_t k = 0; k < wishes.size(); ++k)
    for (const auto& [variable, factor] : wishes[k].terms) multipliers.squares[k] += factor * factor;
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    double largest = 0;
    for (std::size_t k = 0; k < wishes.size(); ++k) largest = std::max(largest, multipliers.settle(k, wishes[k]));
    for (Eigen::Index i = 0; i < low.size(); ++i)
      largest = std::max(largest, multipliers.settle_sides(i, low[i], high[i]));
    if (largest < still) break;
  }
  return multipliers.x.cwiseMax(low).cwiseMin(high);
}

}  // namespace rhizodont
