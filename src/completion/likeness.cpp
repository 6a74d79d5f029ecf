// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// Quadratic discriminant analysis: R. A. Fisher, "The use of multiple measurements in taxonomic problems", 1936;
// C. R. Rao, "The utilization of multiple measurements in problems of biological classification", 1948. Each tooth is
// held against what crowns look like that are not that tooth, for each sees a crown in a pose of its own. Tails: K. L.
// Lange, R. J. A. Little, J. M. G. Taylor, "Robust statistical modeling using the t distribution", 1989.
#include "completion/likeness.hpp"

#include "completion/likeness_vector.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace rhizodont {

Eigen::VectorXd likeness_vector(const CrownTraits& traits, const TypeStatistics& type) {
  constexpr double least_mm = 1e-3;
  Eigen::VectorXd offsets(static_cast<Eigen::Index>(CrownTraits::place_count));
  for (std::size_t i = 0; i < CrownTraits::place_count; ++i)
    offsets[static_cast<Eigen::Index>(i)] = static_cast<double>(traits.offsets[i]);
  offsets -= type.mean_offsets;
  const Eigen::VectorXd along = type.modes.transpose() * offsets;
  const double rest = (offsets - type.modes * along).norm() / std::sqrt(static_cast<double>(offsets.size()));
  constexpr auto agreements = static_cast<Eigen::Index>(CrownTraits::agreement_count);
  Eigen::VectorXd vector(agreements + along.size() + 1);
  for (Eigen::Index i = 0; i < agreements; ++i)
    vector[i] = static_cast<double>(traits.agreement[static_cast<std::size_t>(i)]);
  vector.segment(agreements, along.size()) = along;
  vector[vector.size() - 1] = std::log(rest + least_mm);
  return vector;
}

Eigen::VectorXd standardised(const Eigen::VectorXd& vector, const TypeStatistics& type) {
  constexpr double outermost = 4;
  // The root's columns hold the inverse covariance: root^T root. Deviations are those that the traits have alone.
  const Eigen::MatrixXd factor =
      type.own.root.triangularView<Eigen::Lower>().solve(Eigen::MatrixXd::Identity(vector.size(), vector.size()));
  const Eigen::VectorXd deviation = factor.rowwise().norm();
  return (vector - type.own.mean).cwiseQuotient(deviation).cwiseMax(-outermost).cwiseMin(outermost);
}

double CrownDistribution::squared_distance(const Eigen::VectorXd& x) const {
  return (root.triangularView<Eigen::Lower>() * (x - mean)).squaredNorm();
}

double CrownDistribution::log_density(const Eigen::VectorXd& x) const {
  constexpr double freedom = 10;
  const double tail = 0.5 * (freedom + static_cast<double>(x.size())) * std::log1p(squared_distance(x) / freedom);
  return root.diagonal().array().log().sum() - tail;
}

namespace {

constexpr double absent = 50;  // ln of how much less probable a tooth is whose traits were not asked for

/// What is known of one type: densities and sides of the traits that were given.
struct TypeEvidence {
  std::array<std::optional<Eigen::VectorXd>, 2> vector;  // left, right
  double own = -std::numeric_limits<double>::infinity();
  double left_over_right = 0;
};

double log_share(double log_odds) { return -std::log1p(std::exp(-std::clamp(log_odds, -absent, absent))); }

}  // namespace

Likeness likeness(const std::vector<ToothTraits>& traits, const LikenessModel& model) {
  Likeness result;
  std::array<TypeEvidence, tooth_type_count> types;
  for (const ToothTraits& tooth : traits) {
    const TypeStatistics& type = model.types[tooth.tooth / 2];
    TypeEvidence& evidence = types[tooth.tooth / 2];
    const Eigen::VectorXd x = likeness_vector(tooth.traits, type);
    result.strangeness.push_back(type.own.squared_distance(x) / static_cast<double>(x.size()));
    evidence.own = std::max(evidence.own, model.type_weight * (type.own.log_density(x) - type.others.log_density(x)));
    evidence.vector[tooth.tooth % 2] = standardised(x, type);
  }
  double most = -std::numeric_limits<double>::infinity();
  for (std::size_t t = 0; t < types.size(); ++t) {
    TypeEvidence& evidence = types[t];
    most = std::max(most, evidence.own);
    const auto& [left, right] = evidence.vector;
    evidence.left_over_right = left && right ? model.side_weight * model.types[t].side.dot(*left - *right)
                               : left        ? absent
                                             : -absent;
  }
  double sum = 0;
  for (const ToothTraits& tooth : traits) {
    const TypeEvidence& evidence = types[tooth.tooth / 2];
    const double over_other_side = tooth.tooth % 2 == 0 ? evidence.left_over_right : -evidence.left_over_right;
    result.type_lead.push_back(most - evidence.own);
    result.side_lead.push_back(-over_other_side);
    result.probability.push_back(std::exp(evidence.own - most + log_share(over_other_side)));
    sum += result.probability.back();
  }
  for (double& p : result.probability) p /= sum;
  return result;
}

}  // namespace rhizodont
