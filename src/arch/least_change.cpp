// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "arch/least_change.hpp"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>

namespace rhizodont {
namespace {

/// |x|^2 and the weighed squares of what is missing.
struct Merit {
  const std::vector<LinearWish>& wishes;
  double weight;

  static double missing(const LinearWish& wish, const Eigen::VectorXd& x) {
    double rest = wish.least;
    for (const auto& [variable, factor] : wish.terms) rest -= factor * x[variable];
    return std::max(0.0, rest);
  }

  double at(const Eigen::VectorXd& x) const {
    double sum = x.squaredNorm();
    for (const LinearWish& wish : wishes) sum += weight * missing(wish, x) * missing(wish, x);
    return sum;
  }

  /// Halves of both derivatives; the second is that of the wishes which miss something.
  void derive(const Eigen::VectorXd& x, Eigen::VectorXd& first, Eigen::MatrixXd& second) const {
    first = x;
    second.setIdentity(x.size(), x.size());
    for (const LinearWish& wish : wishes) {
      const double rest = missing(wish, x);
      if (rest == 0) continue;
      for (const auto& [i, a] : wish.terms) {
        first[i] -= weight * rest * a;
        for (const auto& [j, b] : wish.terms) second(i, j) += weight * a * b;
      }
    }
  }
};

}  // namespace

Eigen::VectorXd least_change(const std::vector<LinearWish>& wishes, const Eigen::VectorXd& low,
                             const Eigen::VectorXd& high, double weight) {
  constexpr int most_steps = 100;
  constexpr double still = 1e-11;
  const Merit merit{wishes, weight};
  const auto in_box = [&](const Eigen::VectorXd& x) -> Eigen::VectorXd { return x.cwiseMax(low).cwiseMin(high); };
  Eigen::VectorXd x = in_box(Eigen::VectorXd::Zero(low.size())), first;
  Eigen::MatrixXd second;
  for (int step = 0; step < most_steps; ++step) {
    merit.derive(x, first, second);
    // Variables that a side of the box holds stay out of this step.
    for (Eigen::Index i = 0; i < x.size(); ++i)
      if ((x[i] <= low[i] && first[i] >= 0) || (x[i] >= high[i] && first[i] <= 0)) {
        second.row(i).setZero();
        second.col(i).setZero();
        second(i, i) = 1;
        first[i] = 0;
      }
    const Eigen::VectorXd way = -second.ldlt().solve(first);
    const double before = merit.at(x);
    double share = 1;
    Eigen::VectorXd next = in_box(x + way);
    while (share > 1e-6 && !(merit.at(next) <= before + 2e-4 * first.dot(next - x))) {
      share *= 0.5;
      next = in_box(x + share * way);
    }
    const bool done = !(merit.at(next) < before) || (next - x).cwiseAbs().maxCoeff() < still;
    if (merit.at(next) < before) x = next;
    if (done) break;
  }
  return x;
}

}  // namespace rhizodont
