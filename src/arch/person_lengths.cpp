// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Conditional distributions of a Gaussian: T. W. Anderson, "An Introduction to Multivariate Statistical Analysis",
// theorem 2.5.1. Sources of the correlations: person_lengths.hpp.
#include "arch/person_lengths.hpp"

#include "base/option_range.hpp"
#include "rhizodont/error.hpp"

#include <fmt/format.h>
#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <vector>

namespace rhizodont {
namespace {

/// The tooth of the other side.
int fellow_of(int fdi) {
  const int quadrant = fdi / 10;
  return 10 * (quadrant % 2 == 1 ? quadrant + 1 : quadrant - 1) + fdi % 10;
}

double correlation(int a, int b, const PersonLengthModel& model) {
  if (a == b) return 1;
  return fellow_of(a) == b ? model.fellow : model.others;
}

void require_in_range(const PersonLengthModel& model) {
  require_ranges("a person's root lengths", {{"fellow", model.fellow, OptionRange::at_least(0).below(1)},
                                             {"others", model.others, OptionRange::at_least(0).at_most(model.fellow)},
                                             {"measurement_mm", model.measurement_mm, OptionRange::above(0)}});
}

}  // namespace

std::map<int, LengthExpectation> given_measured(const std::map<int, LengthExpectation>& expected,
                                                const std::map<int, double>& measured_mm,
                                                const PersonLengthModel& model) {
  require_in_range(model);
  if (measured_mm.empty()) return expected;
  std::vector<int> known;
  for (const auto& [fdi, mm] : measured_mm) {
    if (!expected.contains(fdi))
      throw UsageError(fmt::format("A root length was given for tooth {}, which has no root here.", fdi));
    known.push_back(fdi);
  }
  const auto n = static_cast<Eigen::Index>(known.size());
  const auto covariance = [&](int a, int b) {
    return correlation(a, b, model) * expected.at(a).deviation_mm * expected.at(b).deviation_mm;
  };
  Eigen::MatrixXd between(n, n);
  Eigen::VectorXd surprise(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const int a = known[static_cast<std::size_t>(i)];
    surprise(i) = measured_mm.at(a) - expected.at(a).mm;
    for (Eigen::Index j = 0; j < n; ++j) between(i, j) = covariance(a, known[static_cast<std::size_t>(j)]);
    between(i, i) += model.measurement_mm * model.measurement_mm;
  }
  const Eigen::LDLT<Eigen::MatrixXd> solver(between);
  std::map<int, LengthExpectation> result;
  for (const auto& [fdi, before] : expected) {
    if (const auto found = measured_mm.find(fdi); found != measured_mm.end()) {
      result[fdi] = {found->second, model.measurement_mm};
      continue;
    }
    Eigen::VectorXd with_known(n);
    for (Eigen::Index i = 0; i < n; ++i) with_known(i) = covariance(fdi, known[static_cast<std::size_t>(i)]);
    const double variance = before.deviation_mm * before.deviation_mm - with_known.dot(solver.solve(with_known));
    result[fdi] = {before.mm + with_known.dot(solver.solve(surprise)), std::sqrt(std::max(variance, 0.0))};
  }
  return result;
}

}  // namespace rhizodont
